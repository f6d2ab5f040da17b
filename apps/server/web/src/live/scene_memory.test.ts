import { expect, test } from "vitest";
import { SceneMemory } from "./scene_memory";

const grey = (level: number): Uint8Array => new Uint8Array(4).fill(level);

test("the same scene stays, another one does not", () => {
  const memory = new SceneMemory();
  memory.remember(1, grey(100));
  memory.remember(2, grey(108));
  expect(memory.still_shows(1)).toBe(true);
  memory.remember(3, grey(160));
  expect([1, 2, 3].map((frame) => memory.still_shows(frame))).toEqual([false, false, true]);
});

test("what is not known is not held against a result", () => {
  const memory = new SceneMemory();
  expect(memory.still_shows(7)).toBe(true);
  memory.remember(1, grey(0));
  for (let frame = 2; frame < 200; ++frame) memory.remember(frame, grey(255));
  expect(memory.still_shows(1)).toBe(true);
});
