// The mask, at once: everything that is not the object is dimmed.
import type { Point } from "../api/types";
import "./silhouette_overlay.css";

interface Silhouette {
  width: number;
  height: number;
  outline: Point[];
  usable?: boolean;
}

export function SilhouetteOverlay({ of }: { of: Silhouette | null | undefined }) {
  if (!of || of.outline.length < 3) return null;
  const { width, height, outline, usable = true } = of;
  const around = outline.map(([x, y]) => `${x + 0.5} ${y + 0.5}`).join("L");
  return (
    <svg
      class={usable ? "silhouette" : "silhouette refused"}
      viewBox={`0 0 ${width} ${height}`}
      preserveAspectRatio="none"
      aria-hidden="true"
    >
      <path class="silhouette-veil" fill-rule="evenodd" d={`M0 0H${width}V${height}H0Z M${around}Z`} />
      <path class="silhouette-edge" d={`M${around}Z`} />
    </svg>
  );
}
