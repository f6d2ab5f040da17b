import { expect, test } from "vitest";
import type { Detection } from "../api/types";
import { earlier_of, frames_ahead, glide, move_on, travel } from "./smooth";

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

const seen = (frame: number, ...xs: number[]) => ({ frame, detections: xs.map((x) => found_at(x)) });

test("what moves is drawn where it is in the frame on the screen", () => {
  const [before, now] = [seen(10, 0), seen(14, 8)]; // 2 px a frame
  const travels = travel(before, now);
  expect(travels).toEqual([[2, 0]]);
  const [ahead] = move_on(now.detections, travels, frames_ahead(before, now, 17));
  expect(ahead!.box).toEqual([14, 0, 10, 10]);
  expect(ahead!.outline).toEqual([[14, 0], [24, 0], [24, 10]]);
});

test("nothing is guessed far ahead, nor backwards", () => {
  const [before, now] = [seen(10, 0), seen(14, 8)];
  expect(frames_ahead(before, now, 100)).toBe(6);
  expect(frames_ahead(before, now, 12)).toBe(0);
  expect(frames_ahead(now, now, 20)).toBe(0);
});

test("what trembles, is new, or was counted anew stays where it was found", () => {
  for (const before of [seen(10, 7.95), seen(10), seen(10, 100), seen(14, 0), seen(20, 0)])
    expect(travel(before, seen(14, 8))).toEqual([[0, 0]]);
});
