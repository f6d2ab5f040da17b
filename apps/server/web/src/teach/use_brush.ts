// Pointer and keys of the brush, in pixels of the picture.
import { useRef, useState } from "preact/hooks";
import type { Painting } from "./painting";

interface Brush {
  width: number;
  height: number;
  size: number;
  add: boolean;
}

type Place = [number, number];

const kArrows: Record<string, Place> = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] };

export function use_brush(painting: Painting | null, brush: Brush, on_stroke: () => void) {
  const [at, set_at] = useState<Place>([brush.width / 2, brush.height / 2]);
  const last = useRef<Place | null>(null);

  const place = (event: PointerEvent): Place => {
    const bounds = (event.currentTarget as Element).getBoundingClientRect();
    return [
      ((event.clientX - bounds.left) / bounds.width) * brush.width,
      ((event.clientY - bounds.top) / bounds.height) * brush.height,
    ];
  };
  const paint = (from: Place, to: Place): void => {
    if (!painting) return;
    painting.stroke(from, to, brush.size, brush.add);
    on_stroke();
  };

  const handlers = {
    onPointerDown(event: PointerEvent) {
      (event.currentTarget as Element).setPointerCapture(event.pointerId);
      painting?.begin_step();
      last.current = place(event);
      paint(last.current, last.current);
    },
    onPointerMove(event: PointerEvent) {
      const here = place(event);
      set_at(here);
      if (!last.current) return;
      paint(last.current, here);
      last.current = here;
    },
    onPointerUp() {
      last.current = null;
    },
    onPointerCancel() {
      last.current = null;
    },
    onKeyDown(event: KeyboardEvent) {
      const arrow = kArrows[event.key];
      if (arrow) {
        const step = Math.max(1, brush.size / 4);
        set_at(([x, y]) => [
          Math.min(brush.width, Math.max(0, x + arrow[0] * step)),
          Math.min(brush.height, Math.max(0, y + arrow[1] * step)),
        ]);
      } else if (event.key === " ") {
        painting?.begin_step();
        paint(at, at);
      } else {
        return;
      }
      event.preventDefault();
    },
  };
  return { at, handlers };
}
