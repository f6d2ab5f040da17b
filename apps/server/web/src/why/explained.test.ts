import { expect, test } from "vitest";
import type { Explanation } from "../api/types";
import { farthest_first, steps_of } from "./explained";

const explained = (object: string, stage: Explanation["stage"], more: Partial<Explanation> = {}): Explanation => ({
  object,
  found: stage === "found",
  stage,
  reason: "",
  option: "",
  scene_features: 1500,
  similar: 60,
  matched: 12,
  largest_bin: 5,
  clusters: 1,
  ...more,
});

test("what is missed comes first, the one that came farthest before the others", () => {
  const all = [
    explained("mug", "found"),
    explained("book", "similar"),
    explained("tea", "place"),
    explained("salt", "ratio", { matched: 1 }),
    explained("soap", "ratio", { matched: 3 }),
  ];
  expect(farthest_first(all).map(({ object }) => object)).toEqual(["tea", "soap", "salt", "book", "mug"]);
});

test.each([
  ["features", "Features of the picture"],
  ["similar", "Look like one of the object's"],
  ["ratio", "Look more like it than like anything else"],
  ["votes", "Places with enough votes"],
  ["pose", "Features that agree on the strongest"],
  ["chance", "Features that agree on the strongest"],
  ["object", "How probable it is"],
  ["place", "How probable it is"],
  ["competition", "Nothing else explains it better"],
] as const)("what ends at %s ends at one step", (stage, name) => {
  expect(steps_of(explained("mug", stage)).filter(({ ended }) => ended).map((step) => step.name)).toEqual([name]);
});

test("what was found ends nowhere, and what never came to a pose has no number there", () => {
  const best = { inliers: 40, probability: 0.97 } as Explanation["best"];
  const found = steps_of(explained("mug", "found", { best }));
  expect(found.some(({ ended }) => ended)).toBe(false);
  expect(found.map(({ left }) => left)).toEqual(["1,500", "60", "12", "5", "1", "40", "97 %", "yes"]);
  expect(steps_of(explained("mug", "ratio", { clusters: 0 })).map(({ left }) => left).slice(-3)).toEqual(["–", "–", "–"]);
});
