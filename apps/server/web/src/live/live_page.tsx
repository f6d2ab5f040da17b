// What the camera sees and what is recognised in it.
import { useState } from "preact/hooks";
import { get_frame } from "../api/calls";
import { live, result } from "../api/events";
import { link_to } from "../router";
import { State } from "../ui/state";
import { WhyNot } from "../why/why_not";
import { DetectionList } from "./detection_list";
import { LivePicture, live_size } from "./live_picture";
import { Overlay } from "./overlay";
import { Rates } from "./rates";
import { SourceChoice } from "./source_choice";
import { use_current } from "./use_current";
import { use_glide } from "./use_glide";
import "./live_page.css";

export function LivePage() {
  const shown = use_glide();
  const { running, looking, current, on_frame } = use_current();
  const [chosen, set_chosen] = useState<number>();
  const newest = result.value;
  const size = newest ?? live_size();
  return (
    <div class="live">
      <h1 class="hidden-text">Live picture</h1>
      <div class="stack tight">
        <LivePicture label="Live picture with what is recognised" on_frame={on_frame}>
          <Overlay
            width={size.width}
            height={size.height}
            detections={current ? shown : []}
            unknown={current ? newest?.unknown : []}
            chosen={chosen}
          />
        </LivePicture>
        <Rates />
      </div>
      <section class="stack" aria-label="Recognised now">
        <h2>In the picture now</h2>
        {live.value?.objects === 0 ? (
          <State icon="◇" title="Nothing taught yet">
            <p>Teach the first object: an empty table, the object, a few turns. It takes less than a minute.</p>
            <a class="button primary" href={link_to("teach")}>
              Teach an object
            </a>
          </State>
        ) : (
          <DetectionList
            detections={(looking && newest?.detections) || []}
            unknown={looking ? newest?.unknown : []}
            frame={newest?.frame}
            on_choose={set_chosen}
            empty={
              looking
                ? "Nothing that was taught is in the picture."
                : running
                  ? "Recognition is switched off in the settings."
                  : "There is no picture now."
            }
          />
        )}
        {live.value?.objects ? (
          <div class="row">
            <WhyNot picture={() => get_frame(newest?.frame)} />
          </div>
        ) : null}
        <SourceChoice />
      </section>
    </div>
  );
}
