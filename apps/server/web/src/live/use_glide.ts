// The newest detections, moved a little with every picture of the screen.
import type { RefObject } from "preact";
import { useLayoutEffect, useRef, useState } from "preact/hooks";
import { result } from "../api/events";
import type { Detection } from "../api/types";
import { frames_ahead, glide, move_on, travel, type Seen } from "./smooth";

const kLongestMs = 250; // a slower recogniser's outlines do not lag further behind
const kNothing: Seen = { frame: -1, detections: [] };

/// `on_screen`: number of the frame that is shown at the moment.
export function use_glide(on_screen: RefObject<number>): Detection[] {
  const [shown, set_shown] = useState<Detection[]>([]);
  const drawn = useRef<Detection[]>([]);
  const newest = result.value;
  const last = useRef({ seen: kNothing, arrived: 0 });
  // Before the page is painted: the list beside the picture has the newest detections already.
  useLayoutEffect(() => {
    const now = newest ? { frame: newest.frame ?? -1, detections: newest.detections } : kNothing;
    const before = last.current.seen;
    const begin = performance.now();
    const still = matchMedia("(prefers-reduced-motion: reduce)").matches;
    const duration = still ? 0 : Math.min(kLongestMs, begin - last.current.arrived);
    last.current = { seen: now, arrived: begin };

    const from = drawn.current;
    const travels = travel(before, now);
    const ahead = (): number => frames_ahead(before, now, on_screen.current!);
    const ahead_at_begin = ahead();
    const target = move_on(now.detections, travels, ahead_at_begin);
    let last_ahead = -1;
    let last_t = -1;
    let request = 0;
    const step = (): void => {
      const t = duration ? Math.min(1, (performance.now() - begin) / duration) : 1;
      const frames = ahead();
      if (t !== last_t || frames !== last_ahead) {
        drawn.current = move_on(glide(from, target, t), travels, frames - ahead_at_begin);
        set_shown(drawn.current);
        [last_t, last_ahead] = [t, frames];
      }
      if (t < 1 || travels.some(([x, y]) => x !== 0 || y !== 0)) request = requestAnimationFrame(step);
    };
    step();
    return () => cancelAnimationFrame(request);
  }, [newest]);
  return shown;
}
