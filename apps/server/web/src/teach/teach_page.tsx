// New object: by the robot's camera, this device's camera, or pictures - all into one session.
import { useEffect, useMemo, useState } from "preact/hooks";
import { live } from "../api/events";
import type { Saved } from "../api/types";
import { go_to } from "../router";
import { AskFirst } from "../ui/ask_first";
import { Clock } from "../ui/clock";
import { attempt, say } from "../ui/toast";
import { count } from "../ui/numbers";
import { CameraTeach, DeviceTeach } from "./camera_teach";
import { PictureTeach } from "./picture_teach";
import { Resume } from "./resume";
import { SaveForm } from "./save_form";
import { TakenViews } from "./taken_views";
import { Teaching } from "./teaching";
import "./teach_page.css";

const kWays = { camera: "Robot camera", device: "This device", pictures: "Pictures" };
type Way = keyof typeof kWays;

export function TeachPage({ name }: { name: string }) {
  const teaching = useMemo(() => new Teaching(name || undefined), []);
  const [way, set_way] = useState<Way>(live.value?.state === "lost" ? "pictures" : "camera");
  const session = teaching.session.value;
  useEffect(() => {
    const leave = (): void => teaching.leave();
    addEventListener("pagehide", leave);
    return () => {
      removeEventListener("pagehide", leave);
      teaching.close();
    };
  }, []);

  function choose(chosen: Way): void {
    teaching.proposal.value = null;
    teaching.yaw.value ??= chosen === "pictures" ? null : 0;
    set_way(chosen);
  }
  function on_saved(saved: Saved): void {
    const taken_s = Math.round((performance.now() - teaching.begun.value) / 1000);
    say(`“${saved.object}” is known: ${count(saved.views_added, "view")} in ${taken_s} s.`, {
      label: "Show",
      run: () => go_to("objects", saved.object),
    });
    go_to("live");
  }
  return (
    <div class="stack">
      <header class="row spread">
        <h1>{name ? `More views of “${name}”` : "New object"}</h1>
        <div class="row">
          {session && <StartOver teaching={teaching} />}
          <Clock since={teaching.begun.value} />
        </div>
      </header>
      {!session && <Resume on_resume={(left) => teaching.adopt(left)} />}
      <fieldset class="segments" aria-label="Where the pictures come from">
        {(Object.keys(kWays) as Way[]).map((value) => (
          <label key={value} class={value === way ? "segment chosen" : "segment"}>
            <input type="radio" name="from" class="hidden-text" checked={value === way} onChange={() => choose(value)} />
            {kWays[value]}
          </label>
        ))}
      </fieldset>
      {way === "camera" && <CameraTeach teaching={teaching} />}
      {way === "device" && <DeviceTeach teaching={teaching} />}
      {way === "pictures" && <PictureTeach teaching={teaching} />}
      {session && session.views.length > 0 && (
        <section class="card teach-save" aria-label="Taken so far">
          <div class="stack tight">
            <h2>{count(session.views.length, "view")} taken</h2>
            <TakenViews teaching={teaching} />
          </div>
          <SaveForm teaching={teaching} name={name} on_saved={on_saved} />
        </section>
      )}
    </div>
  );
}

function StartOver({ teaching }: { teaching: Teaching }) {
  const discard = (): void => void attempt(() => teaching.discard());
  const views = teaching.session.value!.views.length;
  if (views === 0)
    return (
      <button class="button plain" onClick={discard}>
        Start over
      </button>
    );
  return (
    <AskFirst
      label="Start over"
      title="Start over?"
      text={`${count(views, "view")} taken so far will be lost.`}
      keep="Go on"
      on_sure={discard}
    />
  );
}
