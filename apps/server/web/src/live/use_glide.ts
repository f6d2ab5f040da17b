// The newest detections, moved a little with every picture of the screen.
import { useEffect, useRef, useState } from "preact/hooks";
import { result } from "../api/events";
import type { Detection } from "../api/types";
import { glide } from "./smooth";

const kLongestMs = 250; // a slower recogniser's outlines do not lag further behind

export function use_glide(): Detection[] {
  const [shown, set_shown] = useState<Detection[]>([]);
  const drawn = useRef<Detection[]>([]);
  const newest = result.value;
  const arrived = useRef(0);
  useEffect(() => {
    const target = newest?.detections ?? [];
    const from = drawn.current;
    const begin = performance.now();
    const still = matchMedia("(prefers-reduced-motion: reduce)").matches;
    const duration = still ? 0 : Math.min(kLongestMs, begin - arrived.current);
    arrived.current = begin;
    let request = 0;
    const step = (): void => {
      const t = duration ? Math.min(1, (performance.now() - begin) / duration) : 1;
      drawn.current = glide(from, target, t);
      set_shown(drawn.current);
      if (t < 1) request = requestAnimationFrame(step);
    };
    step();
    return () => cancelAnimationFrame(request);
  }, [newest]);
  return shown;
}
