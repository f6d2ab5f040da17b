// Boxes in whole pixels of a picture.
export interface Box {
  x: number;
  y: number;
  width: number;
  height: number;
}

/// The box with two given corners, cut to the picture, at least 1 x 1.
export function box_between(a: [number, number], b: [number, number], width: number, height: number): Box {
  const [left, right] = span(a[0], b[0], width);
  const [top, bottom] = span(a[1], b[1], height);
  return { x: left, y: top, width: right - left, height: bottom - top };
}

function span(a: number, b: number, size: number): [number, number] {
  const low = Math.min(size - 1, Math.max(0, Math.floor(Math.min(a, b))));
  const high = Math.min(size, Math.max(low + 1, Math.ceil(Math.max(a, b))));
  return [low, high];
}
