import { expect, test } from "vitest";
import { in_order } from "./events";
import type { Detection, Recognition } from "./types";

const found = (object: string, x: number): Detection => ({
  object,
  view: "1",
  confidence: 0.5,
  probability: 0.5,
  inliers: 9,
  features_in_area: 20,
  outline: [],
  box: [x, 0, 10, 10],
});

test("detections keep their places however sure they are", () => {
  const detections = [found("mug", 70), found("book", 5), found("mug", 20)];
  const { detections: ordered } = in_order({ detections } as Recognition);
  expect(ordered.map(({ object, box }) => `${object} ${box[0]}`)).toEqual(["book 5", "mug 20", "mug 70"]);
});
