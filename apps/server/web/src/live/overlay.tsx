// Outlines and names over a picture of `width` x `height`; the parent gives the place.
import { colour_of } from "./colour";
import type { Detection, UnknownRegion } from "../api/types";
import { sureness } from "./sureness";
import "./overlay.css";

interface Props {
  width: number;
  height: number;
  detections: Detection[];
  unknown?: UnknownRegion[];
  chosen?: number;  // unknown parts come after the detections
}

export function Overlay({ width, height, detections, unknown = [], chosen }: Props) {
  return (
    <div class="overlay" aria-hidden="true">
      <svg viewBox={`0 0 ${width} ${height}`} preserveAspectRatio="none">
        {unknown.map(({ box: [x, y, w, h] }, i) => (
          <g key={`unknown ${i}`} class={detections.length + i === chosen ? "found unknown chosen" : "found unknown"}>
            <rect class="halo" x={x} y={y} width={w} height={h} />
            <rect class="edge" x={x} y={y} width={w} height={h} />
          </g>
        ))}
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
            {found.object} <b>{sureness(found)}</b>
          </span>
        );
      })}
    </div>
  );
}

const clamp = (share: number): number => Math.min(92, Math.max(0, share));
