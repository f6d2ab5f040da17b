import { expect, test } from "vitest";
import type { Detection } from "../api/types";
import { evidence_of, sureness } from "./sureness";

const found = (probability: number, confidence: number): Detection => ({
  object: "mug",
  view: "1",
  confidence,
  probability,
  inliers: 26,
  features_in_area: 100,
  outline: [],
  box: [0, 0, 1, 1],
});

test("the calibrated probability is shown, never as certain", () => {
  expect(sureness(found(0.93, 0.26))).toBe("93 %");
  expect(sureness(found(0.9996, 0.26))).toBe("> 99 %");
});

test("without one it is Eq. 11, and says so", () => {
  expect(sureness(found(0, 0.26))).toBe("26 % (Eq. 11)");
});

test("the features behind it are counted", () => {
  expect(evidence_of(found(0.9, 0.26))).toBe("26 of 100 features agree: 26 % (Eq. 11)");
});
