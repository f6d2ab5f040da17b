import { expect, test } from "vitest";
import { box_between } from "./box";

test("any two corners make the same box", () => {
  const box = { x: 10, y: 20, width: 30, height: 5 };
  expect(box_between([10, 20], [40, 25], 100, 100)).toEqual(box);
  expect(box_between([40, 25], [10, 20], 100, 100)).toEqual(box);
});

test("a box stays in the picture and is never empty", () => {
  expect(box_between([-50, -50], [500, 500], 64, 48)).toEqual({ x: 0, y: 0, width: 64, height: 48 });
  expect(box_between([5, 5], [5, 5], 64, 48)).toEqual({ x: 5, y: 5, width: 1, height: 1 });
  expect(box_between([99, 99], [120, 130], 64, 48)).toEqual({ x: 63, y: 47, width: 1, height: 1 });
});
