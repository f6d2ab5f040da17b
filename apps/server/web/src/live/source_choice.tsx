// Which camera? Shown when there is a choice; "client" is a browser's own, sent frame by frame.
import { useState } from "preact/hooks";
import { get_source, set_source } from "../api/calls";
import { live } from "../api/events";
import { use_loaded } from "../ui/loaded";
import { attempt } from "../ui/toast";
import { Sender } from "./sender";

export function SourceChoice() {
  const { data, reload } = use_loaded(get_source, [live.value?.source]);
  const [sending, set_sending] = useState(false);
  if (!data) return null;
  return (
    <div class="stack tight">
      {data.choices.length > 1 && (
        <label class="field">
          <span class="label">Source of the picture</span>
          <select
            class="input"
            value={data.source}
            onChange={(event) => void attempt(() => set_source(event.currentTarget.value)).then(reload)}
          >
            {data.choices.map((choice) => (
              <option key={choice} value={choice}>
                {choice === "client" ? "A browser's camera" : choice}
              </option>
            ))}
          </select>
        </label>
      )}
      {data.source === "client" && (
        <>
          <button class="button" aria-pressed={sending} onClick={() => set_sending(!sending)}>
            {sending ? "Stop sending" : "Send this device's camera"}
          </button>
          {sending && <Sender on_end={() => set_sending(false)} />}
        </>
      )}
    </div>
  );
}
