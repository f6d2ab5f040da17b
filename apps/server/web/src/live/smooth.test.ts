import { expect, test } from "vitest";
import type { Detection } from "../api/types";
import { earlier_of, glide } from "./smooth";

function found_at(x: number, object = "mug", view = "1"): Detection {
  const outline: [number, number][] = [[x, 0], [x + 10, 0], [x + 10, 10]];
  return { object, view, confidence: 0.5, probability: 0.5, inliers: 9, features_in_area: 20, outline, box: [x, 0, 10, 10] };
}

test("an outline glides from where it was", () => {
  const [half] = glide([found_at(0)], [found_at(8)], 0.5);
  expect(half!.outline[0]).toEqual([4, 0]);
  expect(half!.box).toEqual([4, 0, 10, 10]);
  expect(glide([found_at(0)], [found_at(8)], 1)[0]!.box[0]).toBe(8);
});

test("of two copies the nearer one is the earlier", () => {
  expect(earlier_of(found_at(20), [found_at(11), found_at(18)])!.box[0]).toBe(18);
});

test("what jumped, or is another object or view, appears where it is", () => {
  for (const old of [found_at(100), found_at(0, "tea"), found_at(0, "mug", "2")])
    expect(glide([old], [found_at(8)], 0.5)[0]!.box[0]).toBe(8);
  expect(glide([], [found_at(8)], 0)).toEqual([found_at(8)]);
});
