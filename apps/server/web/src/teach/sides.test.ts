import { expect, test } from "vitest";
import { apart, covered, sector_path, wrap } from "./sides";

test("directions are apart the shorter way round", () => {
  expect(apart(350, 10)).toBe(20);
  expect(apart(0, 180)).toBe(180);
  expect(apart(-30, 330)).toBe(0);
  expect(wrap(-30)).toBe(330);
  expect(wrap(720)).toBe(0);
});

test("a view covers its own sector and those within reach", () => {
  expect(covered([], 15)).toEqual(Array(12).fill(false));
  expect(covered([0], 15).map(Number)).toEqual([1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0]);
  expect(covered([0], 30).map(Number)).toEqual([1, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1]);
});

test("views every 36 degrees cover all sides", () => {
  expect(covered(Array.from({ length: 10 }, (_, i) => i * 36), 18).every(Boolean)).toBe(true);
});

test("a sector begins and ends where it should", () => {
  expect(sector_path(0, 90, 1, 2)).toBe("M 0.00 2.00 A 2 2 0 0 1 -2.00 0.00 L -1.00 0.00 A 1 1 0 0 0 0.00 1.00 Z");
});
