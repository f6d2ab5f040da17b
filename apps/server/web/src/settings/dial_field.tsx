// How careful is recognition to be?
import { useId } from "preact/hooks";
import type { Setting } from "../api/types";
import { dial_range, in_words, to_position, to_value } from "./dial";

interface Props {
  setting: Setting;
  value: number;
  on_change: (value: number) => void;
}

export function Dial({ setting, value, on_change }: Props) {
  const id = useId();
  return (
    <section id={setting.name} class="card stack tight" aria-label="False alarms">
      <h2>
        <label htmlFor={id}>How careful?</label>
      </h2>
      <p class="muted">{setting.help}</p>
      <input
        id={id}
        type="range"
        {...dial_range(setting)}
        step={5}
        value={to_position(value)}
        aria-valuetext={in_words(value)}
        onInput={(event) => on_change(to_value(event.currentTarget.valueAsNumber))}
      />
      <div class="dial-scale small muted">
        <span>Careful: misses some objects</span>
        <span class="number">Eager: sees some too many</span>
      </div>
      <output htmlFor={id}>
        {value} in 1000. {in_words(value)}
      </output>
    </section>
  );
}
