import { expect, test } from "vitest";
import { alpha_from_grey, grey_from_alpha } from "./mask";

test("a mask comes back from the brush as it went in", () => {
  const grey = [0, 0, 0, 255, 255, 255, 255, 255];
  const pixels = new Uint8ClampedArray(grey);
  alpha_from_grey(pixels);
  expect([...pixels]).toEqual([255, 255, 255, 0, 255, 255, 255, 255]);
  grey_from_alpha(pixels);
  expect([...pixels]).toEqual(grey);
});

test("half and less is not the object", () => {
  const pixels = new Uint8ClampedArray([127, 127, 127, 255, 128, 128, 128, 255]);
  alpha_from_grey(pixels);
  expect([pixels[3], pixels[7]]).toEqual([0, 255]);
});
