import { expect, test } from "vitest";
import type { Setting } from "../api/types";
import { dial_range, in_words, is_dial, to_position, to_value } from "./dial";

const dial: Setting = {
  name: "recognize.verify.false_alarms_per_1000_images",
  group: "recognize",
  level: "basic",
  type: "number",
  value: 1,
  default: 1,
  min: 1e-9,
  max: 1e6,
  unit: "",
  help: "",
};

test("positions and values are each other's inverse", () => {
  for (let position = -40; position <= 20; ++position) expect(to_position(to_value(position))).toBe(position);
  expect(to_value(0)).toBe(1);
});

test("the dial reaches a value that was set elsewhere, and never leaves the option's range", () => {
  expect(dial_range(dial)).toEqual({ min: -40, max: 20 });
  expect(dial_range({ ...dial, value: 1e-8 })).toEqual({ min: -80, max: 20 });
  expect(dial_range({ ...dial, min: 0.1, max: 10 })).toEqual({ min: -10, max: 10 });
});

test("it is said in words", () => {
  expect(in_words(1)).toContain("one picture in 1,000 ");
  expect(in_words(0.01)).toContain("one picture in 100,000 ");
  expect(in_words(1000)).toContain("every picture");
});

test("the dial is found by its name", () => {
  expect([is_dial(dial), is_dial({ ...dial, name: "recognize.vote.octaves" })]).toEqual([true, false]);
});
