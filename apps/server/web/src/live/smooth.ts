// Detections come slower and later than frames: between two of them the outlines glide, and move on as
// they moved last to where they are in the frame on the screen.
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

const kMostAhead = 1.5; // times the frames between the last two results: farther off it is a guess
const kStill = 0.01; // of the object's size: that much a detection trembles

/// Detections of a frame.
export interface Seen {
  frame: number;
  detections: Detection[];
}

/// How far each detection of `now` moves from frame to frame, px; nothing where that is not known.
export function travel(before: Seen, now: Seen): Point[] {
  const frames = now.frame - before.frame;
  return now.detections.map((found) => {
    const old = frames > 0 ? earlier_of(found, before.detections) : undefined;
    if (!old) return [0, 0];
    const [a, b] = [centre(old), centre(found)];
    if (distance(a, b) < kStill * Math.max(found.box[2], found.box[3])) return [0, 0];
    return [(b[0] - a[0]) / frames, (b[1] - a[1]) / frames];
  });
}

/// The frames from `now` to the one on the screen over which it is known how things move on.
export function frames_ahead(before: Seen, now: Seen, on_screen: number): number {
  return Math.min(Math.max(0, on_screen - now.frame), kMostAhead * Math.max(0, now.frame - before.frame));
}

/// Each detection shifted by `frames` times its travel.
export function move_on(detections: Detection[], travels: Point[], frames: number): Detection[] {
  return detections.map((found, i) => {
    const [dx, dy] = [travels[i]![0] * frames, travels[i]![1] * frames];
    if (dx === 0 && dy === 0) return found;
    const [x, y, width, height] = found.box;
    return {
      ...found,
      outline: found.outline.map(([px, py]): Point => [px + dx, py + dy]),
      box: [x + dx, y + dy, width, height],
    };
  });
}
