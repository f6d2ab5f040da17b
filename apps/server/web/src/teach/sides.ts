// The circle of sides an object has, as seen from above: which are covered by the views taken.

/// Difference of two directions, [0, 180] degrees.
export function apart(a: number, b: number): number {
  const turn = Math.abs(a - b) % 360;
  return Math.min(turn, 360 - turn);
}

export const wrap = (yaw: number): number => ((yaw % 360) + 360) % 360;

/// Marks each of `sectors` equal sectors (the first is centred on 0 degrees) that a view reaches:
/// recognition holds for `reach_deg` of turn to either side of a view.
export function covered(yaws: number[], reach_deg: number, sectors = 12): boolean[] {
  const step = 360 / sectors;
  return Array.from({ length: sectors }, (_, i) =>
    yaws.some((yaw) => apart(yaw, i * step) <= Math.max(reach_deg, step / 2)),
  );
}

/// SVG path of a sector of a ring about (0, 0); 0 degrees is at the bottom (towards the camera), and
/// a turn to the left of the camera goes clockwise as seen from above.
export function sector_path(from_deg: number, to_deg: number, inner: number, outer: number): string {
  const at = (degrees: number, radius: number): string => {
    const angle = ((degrees + 90) * Math.PI) / 180;
    return `${(radius * Math.cos(angle)).toFixed(2)} ${(radius * Math.sin(angle)).toFixed(2)}`;
  };
  const large = to_deg - from_deg > 180 ? 1 : 0;
  return (
    `M ${at(from_deg, outer)} A ${outer} ${outer} 0 ${large} 1 ${at(to_deg, outer)} ` +
    `L ${at(to_deg, inner)} A ${inner} ${inner} 0 ${large} 0 ${at(from_deg, inner)} Z`
  );
}
