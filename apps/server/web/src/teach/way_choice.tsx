// Where is the object in the picture?
export type Way = "whole" | "box" | "background";

const kWays: [Way, string][] = [
  ["whole", "The whole picture (a cover, a label)"],
  ["box", "In a box that I draw"],
  ["background", "What differs from the empty table"],
];

interface Props {
  way: Way;
  has_background: boolean;
  on_choose: (way: Way) => void;
}

export function WayChoice({ way, has_background, on_choose }: Props) {
  return (
    <fieldset class="stack tight">
      <legend class="label">Where is the object?</legend>
      {kWays
        .filter(([value]) => value !== "background" || has_background)
        .map(([value, label]) => (
          <label key={value} class="choice">
            <input type="radio" name="way" checked={way === value} onChange={() => on_choose(value)} />
            {label}
          </label>
        ))}
    </fieldset>
  );
}
