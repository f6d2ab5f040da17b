// One colour a name, the same on every page; all are bright enough on a dark halo.
const kGoldenTurn = 137.508; // spreads any number of hues

export function colour_of(name: string): string {
  let hash = 0;
  for (const letter of name) hash = (hash * 31 + letter.codePointAt(0)!) % 9973;
  return `hsl(${Math.round((hash * kGoldenTurn) % 360)} 85% 70%)`;
}
