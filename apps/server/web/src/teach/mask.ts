// Masks as the server has them (grey, bright = object) and as a canvas paints them (alpha = object).

/// In place: RGBA of a grey mask becomes white with the mask in alpha.
export function alpha_from_grey(rgba: Uint8ClampedArray): void {
  for (let i = 0; i < rgba.length; i += 4) {
    const object = rgba[i]! > 127 ? 255 : 0;
    rgba[i] = rgba[i + 1] = rgba[i + 2] = 255;
    rgba[i + 3] = object;
  }
}

/// In place: the other way round; soft edges of the brush are cut at half.
export function grey_from_alpha(rgba: Uint8ClampedArray): void {
  for (let i = 0; i < rgba.length; i += 4) {
    rgba[i] = rgba[i + 1] = rgba[i + 2] = rgba[i + 3]! > 127 ? 255 : 0;
    rgba[i + 3] = 255;
  }
}
