// Which camera? Shown when there is a choice; "client" is this device's own, sent frame by frame.
import { useEffect } from "preact/hooks";
import { get_source, post_frame, set_source } from "../api/calls";
import { live } from "../api/events";
import { use_device_camera } from "../ui/device_camera";
import { use_loaded } from "../ui/loaded";
import { attempt, say_error } from "../ui/toast";

export function SourceChoice() {
  const { data, reload } = use_loaded(get_source, [live.value?.source]);
  if (!data || data.choices.length < 2) return null;
  return (
    <div class="stack tight">
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
      {data.source === "client" && <Sender />}
    </div>
  );
}

function Sender() {
  const camera = use_device_camera();
  useEffect(() => {
    if (!camera.ready) return;
    let going = true;
    void (async () => {
      while (going) await post_frame(await camera.grab());
    })().catch(say_error);
    return () => {
      going = false;
    };
  }, [camera.ready]);
  return (
    <div class="note small">
      <video ref={camera.video} muted playsInline width={96} height={72} />
      {camera.problem || (camera.ready ? "Frames of this device's camera are being sent." : "Asking for the camera …")}
    </div>
  );
}
