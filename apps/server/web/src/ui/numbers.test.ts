import { expect, test } from "vitest";
import { clock, count, degrees, milliseconds, percent, sentence } from "./numbers";

test("what cannot be known is a dash", () => {
  expect([percent(null), percent(undefined), degrees(null)]).toEqual(["–", "–", "–"]);
  expect([percent(0), percent(1), degrees(0)]).toEqual(["0 %", "100 %", "0°"]);
});

test("one view, two views, many", () => {
  expect([0, 1, 2, 12000].map((n) => count(n, "view"))).toEqual(["0 views", "1 view", "2 views", "12,000 views"]);
});

test("the clock does not run backwards", () => {
  expect([-5, 0, 7999, 60000, 75000].map(clock)).toEqual(["0:00", "0:00", "0:07", "1:00", "1:15"]);
  expect([0.04, 9.96, 120.4].map(milliseconds)).toEqual(["0.0 ms", "10.0 ms", "120 ms"]);
});

test("a message becomes a sentence", () => {
  expect(sentence("the camera has moved")).toBe("The camera has moved.");
  expect(sentence("Is it there?")).toBe("Is it there?");
});
