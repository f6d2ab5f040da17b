// Detections in words: for reading, for screen readers, and for saying that one is wrong.
import { add_impostor, delete_impostor } from "../api/calls";
import type { Detection } from "../api/types";
import { link_to } from "../router";
import { percent } from "../ui/numbers";
import { attempt, say } from "../ui/toast";
import { colour_of } from "./colour";

interface Props {
  detections: Detection[];
  frame?: number; // of the live picture, or ...
  picture?: Blob; // ... the picture that was sent
  on_choose: (index?: number) => void;
  empty: string;
}

export function DetectionList({ detections, frame, picture, on_choose, empty }: Props) {
  async function mark_wrong(found: Detection): Promise<void> {
    await attempt(async () => {
      const { impostor } = await add_impostor(found, { frame, body: picture });
      say(`Noted: that is not “${found.object}”.`, {
        label: "Undo",
        run: () => void attempt(() => delete_impostor(impostor)),
      });
    });
  }
  if (detections.length === 0) return <p class="detections muted">{empty}</p>;
  return (
    <ul class="detections">
      {detections.map((found, i) => (
        <li
          key={i}
          class="detection"
          style={{ borderLeftColor: colour_of(found.object) }}
          onMouseEnter={() => on_choose(i)}
          onMouseLeave={() => on_choose()}
          onFocusCapture={() => on_choose(i)}
          onBlurCapture={() => on_choose()}
        >
          <a href={link_to("objects", found.object)}>{found.object}</a>
          <span class="number">{percent(found.confidence)}</span>
          <button
            class="button plain"
            aria-label={`${found.object} is wrong here`}
            title="Marks this place as something that only looks like it"
            onClick={() => void mark_wrong(found)}
          >
            Wrong
          </button>
          {found.alternatives?.length ? (
            <span class="detection-also small muted">or {found.alternatives.join(", ")}: cannot be told apart here</span>
          ) : null}
        </li>
      ))}
    </ul>
  );
}
