// The mask, at once: everything that is not the object is dimmed.
import type { Proposal } from "../api/types";
import "./proposal_overlay.css";

export function ProposalOverlay({ proposal }: { proposal: Proposal | null }) {
  if (!proposal || proposal.outline.length < 3) return null;
  const { width, height, outline, usable } = proposal;
  const around = outline.map(([x, y]) => `${x + 0.5} ${y + 0.5}`).join("L");
  return (
    <svg
      class={usable ? "proposal" : "proposal refused"}
      viewBox={`0 0 ${width} ${height}`}
      preserveAspectRatio="none"
      aria-hidden="true"
    >
      <path class="proposal-veil" fill-rule="evenodd" d={`M0 0H${width}V${height}H0Z M${around}Z`} />
      <path class="proposal-edge" d={`M${around}Z`} />
    </svg>
  );
}
