// Detections in words: for reading, for screen readers, and for saying that one is wrong.
import { add_impostor, delete_impostor } from "../api/calls";
import type { Detection, UnknownRegion } from "../api/types";
import { link_to } from "../router";
import { count } from "../ui/numbers";
import { attempt, say } from "../ui/toast";
import { colour_of } from "./colour";
import { evidence_of, sureness } from "./sureness";

interface Props {
  detections: Detection[];
  unknown?: UnknownRegion[];
  frame?: number; // of the live picture, or ...
  picture?: Blob; // ... the picture that was sent
  on_choose: (index?: number) => void;  // unknown parts come after the detections
  empty: string;
}

export function DetectionList({ detections, unknown = [], frame, picture, on_choose, empty }: Props) {
  async function mark_wrong(found: Detection): Promise<void> {
    await attempt(async () => {
      const { impostor } = await add_impostor(found, { frame, body: picture });
      say(`Noted: that is not “${found.object}”.`, {
        label: "Undo",
        run: () => void attempt(() => delete_impostor(impostor)),
      });
    });
  }
  const choosing = (i: number) => ({
    onMouseEnter: () => on_choose(i),
    onMouseLeave: () => on_choose(),
    onFocusCapture: () => on_choose(i),
    onBlurCapture: () => on_choose(),
  });
  return (
    <ul class="detections">
      {detections.length === 0 && <li class="muted">{empty}</li>}
      {detections.map((found, i) => (
        <li
          key={i}
          class="detection"
          style={{ borderLeftColor: colour_of(found.object) }}
          {...choosing(i)}
        >
          <a href={link_to("objects", found.object)}>{found.object}</a>
          <span class="number">{sureness(found)}</span>
          <button
            class="button plain"
            aria-label={`${found.object} is wrong here`}
            title="Marks this place as something that only looks like it"
            onClick={() => void mark_wrong(found)}
          >
            Wrong
          </button>
          <span class="detection-also small muted">{evidence_of(found)}</span>
          {found.alternatives?.length ? (
            <span class="detection-also small muted">or {found.alternatives.join(", ")}: cannot be told apart here</span>
          ) : null}
        </li>
      ))}
      {unknown.map(({ features }, i) => (
        <li key={`unknown ${i}`} class="detection unknown muted" {...choosing(detections.length + i)}>
          <span>Something unknown</span>
          <span class="number small">{count(features, "feature")}</span>
        </li>
      ))}
    </ul>
  );
}
