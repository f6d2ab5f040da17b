// Detections come slower than frames: between two of them the outlines glide.
import type { Detection, Point } from "../api/types";

const centre = (found: Detection): Point => [found.box[0] + found.box[2] / 2, found.box[1] + found.box[3] / 2];
const distance = (a: Point, b: Point): number => Math.hypot(a[0] - b[0], a[1] - b[1]);
const mix = (a: number, b: number, t: number): number => a + (b - a) * t;

/// The earlier detection of the same instance: same object and view, nearest, moved by less than its
/// own size. Only then do the outline's points correspond.
export function earlier_of(now: Detection, before: Detection[]): Detection | undefined {
  const reach = Math.max(now.box[2], now.box[3]);
  return before
    .filter((old) => old.object === now.object && old.view === now.view && old.outline.length === now.outline.length)
    .map((old) => ({ old, away: distance(centre(old), centre(now)) }))
    .filter(({ away }) => away < reach)
    .sort((a, b) => a.away - b.away)[0]?.old;
}

/// `now`, drawn the share `t` in [0, 1] of the way from where it was in `before`.
export function glide(before: Detection[], now: Detection[], t: number): Detection[] {
  if (t >= 1) return now;
  return now.map((found) => {
    const old = earlier_of(found, before);
    if (!old) return found;
    return {
      ...found,
      outline: found.outline.map((p, i) => [mix(old.outline[i]![0], p[0], t), mix(old.outline[i]![1], p[1], t)]),
      box: found.box.map((value, i) => mix(old.box[i]!, value, t)) as Detection["box"],
    };
  });
}
