// One option, made from its description: the fitting control, its help, the way back to the default.
import { useId } from "preact/hooks";
import type { Setting, SettingValue } from "../api/types";

interface Props {
  setting: Setting;
  value: SettingValue;  // as it is shown, perhaps not sent yet
  on_change: (value: SettingValue) => void;
}

export function SettingField({ setting, value, on_change }: Props) {
  const id = useId();
  const { fixed, unit, help, name } = setting;
  return (
    <div class="setting" id={name}>
      <div>
        <label htmlFor={id}>{title_of(name)}</label>
        <p id={`${id}-help`} class="muted small">
          {help} {fixed && "Decided by the features of the database."}
        </p>
      </div>
      <div class="setting-control">
        <Control id={id} setting={setting} value={value} on_change={on_change} />
        <span class="small muted">{unit}</span>
        <button
          class="button plain small"
          hidden={value === setting.default || fixed}
          aria-label={`Default for ${title_of(name)}`}
          onClick={() => on_change(setting.default)}
        >
          Default: {String(setting.default)}
        </button>
      </div>
    </div>
  );
}

function Control({ id, setting, value, on_change }: Props & { id: string }) {
  const shared = { id, disabled: setting.fixed, "aria-describedby": `${id}-help` };
  if (setting.type === "boolean")
    return (
      <input
        {...shared}
        type="checkbox"
        checked={value === true}
        onChange={(event) => on_change(event.currentTarget.checked)}
      />
    );
  if (setting.choices?.length)
    return (
      <select {...shared} class="input" value={String(value)} onChange={(event) => on_change(event.currentTarget.value)}>
        {setting.choices.map((choice) => (
          <option key={choice}>{choice}</option>
        ))}
      </select>
    );
  if (setting.type === "text")
    return (
      <input {...shared} class="input" value={String(value)} onChange={(event) => on_change(event.currentTarget.value)} />
    );
  return (
    <input
      {...shared}
      class="input number"
      type="number"
      step={setting.type === "integer" ? 1 : "any"}
      min={setting.min}
      max={setting.max}
      value={String(value)}
      onChange={(event) => {
        if (event.currentTarget.reportValidity() && event.currentTarget.value !== "")
          on_change(event.currentTarget.valueAsNumber);
      }}
    />
  );
}

/// "recognize.verify.min_inliers" -> "Min inliers"
export function title_of(name: string): string {
  const words = name.split(".").at(-1)!.replaceAll("_", " ");
  return words.charAt(0).toUpperCase() + words.slice(1);
}
