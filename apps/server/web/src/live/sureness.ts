// How sure is a detection? The calibrated probability; where none is computed, Eq. 11, and that is said.
import type { Detection } from "../api/types";
import { percent } from "../ui/numbers";

export function sureness({ probability, confidence }: Detection): string {
  if (!probability) return `${percent(confidence)} (Eq. 11)`;
  return probability > 0.99 ? "> 99 %" : percent(probability); // nothing is quite certain
}

/// What stands behind it, for whoever wants to know.
export function evidence_of({ inliers, features_in_area, confidence }: Detection): string {
  return `${inliers} of ${features_in_area} features agree: ${percent(confidence)} (Eq. 11)`;
}
