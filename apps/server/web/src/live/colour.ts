// One colour a name, the same on every page; all are bright enough on a dark halo.
//
const kColours = ["#5ee6c5", "#ffb454", "#8ab8ff", "#ff8fa3", "#c8f06b", "#e0a3ff", "#ffe26b", "#7de3ff"];

export function colour_of(name: string): string {
  let hash = 0;
  for (const letter of name) hash = (hash * 31 + letter.codePointAt(0)!) >>> 0;
  return kColours[hash % kColours.length]!;
}
