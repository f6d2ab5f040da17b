// Outlines and names over a picture of `width` x `height`; the parent gives the place.
import { colour_of } from "./colour";
import { percent } from "../ui/numbers";
import type { Detection } from "../api/types";
import "./overlay.css";

interface Props {
  width: number;
  height: number;
  detections: Detection[];
  chosen?: number;
}

export function Overlay({ width, height, detections, chosen }: Props) {
  return (
    <div class="overlay" aria-hidden="true">
      <svg viewBox={`0 0 ${width} ${height}`} preserveAspectRatio="none">
        {detections.map((found, i) => {
          const points = found.outline.map(([x, y]) => `${x + 0.5},${y + 0.5}`).join(" ");
          return (
            <g key={i} class={i === chosen ? "found chosen" : "found"}>
              <polygon class="halo" points={points} />
              <polygon class="edge" points={points} stroke={colour_of(found.object)} />
            </g>
          );
        })}
      </svg>
      {detections.map((found, i) => {
        const [x, y, w] = found.box;
        const at_right = x + w / 2 > width / 2; // there the name ends with the object, or it would be cut
        return (
          <span
            key={i}
            class="found-name"
            style={{
              [at_right ? "right" : "left"]: `${clamp(((at_right ? width - x - w : x) / width) * 100)}%`,
              top: `${clamp((y / height) * 100)}%`,
              borderColor: colour_of(found.object),
            }}
          >
            {found.object} <b>{percent(found.confidence)}</b>
          </span>
        );
      })}
    </div>
  );
}

const clamp = (share: number): number => Math.min(92, Math.max(0, share));
