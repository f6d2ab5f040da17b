// What the camera sees and what is recognised in it.
import { useRef, useState } from "preact/hooks";
import { get_frame } from "../api/calls";
import { live, result } from "../api/events";
import type { Detection } from "../api/types";
import { link_to } from "../router";
import { Announcement } from "../ui/announcement";
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
  const on_screen = useRef(-1); // number of the frame
  const shown = use_glide(on_screen);
  const { running, looking, current, on_frame } = use_current();
  const [chosen, set_chosen] = useState<number>();
  const newest = result.value;
  const size = newest ?? live_size();
  const found = (looking && newest?.detections) || [];
  const nothing = looking
    ? "Nothing that was taught is in the picture."
    : running
      ? "Recognition is switched off in the settings."
      : "There is no picture now.";
  return (
    <div class="live">
      <h1 class="hidden-text">Live picture</h1>
      <div class="stack tight">
        <LivePicture
          label="Live picture with what is recognised"
          on_frame={(frame, thumbnail) => {
            on_screen.current = frame;
            on_frame(frame, thumbnail);
          }}
        >
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
            detections={found}
            unknown={looking ? newest?.unknown : []}
            frame={newest?.frame}
            on_choose={set_chosen}
            empty={nothing}
          />
        )}
        {live.value?.objects ? <Announcement text={names_of(found) || nothing} /> : null}
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

const names_of = (found: Detection[]): string => [...new Set(found.map(({ object }) => object))].join(", ");
