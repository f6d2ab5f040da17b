// Is it recognised in this picture? And if not, why?
import { useEffect, useState } from "preact/hooks";
import { recognize } from "../api/calls";
import type { Recognition } from "../api/types";
import { DetectionList } from "../live/detection_list";
import { Overlay } from "../live/overlay";
import { DropZone } from "../ui/drop_zone";
import { milliseconds } from "../ui/numbers";
import { Stage } from "../ui/stage";
import { say_error } from "../ui/toast";
import { WhyNot } from "../why/why_not";
import "./try_page.css";

interface Tried {
  file: File;
  url: string;
  result?: Recognition;
}

export function TryPage() {
  const [tried, set_tried] = useState<Tried | null>(null);
  const [chosen, set_chosen] = useState<number>();
  useEffect(() => () => { if (tried) URL.revokeObjectURL(tried.url); }, [tried?.url]);

  async function try_picture(file: File): Promise<void> {
    const url = URL.createObjectURL(file);
    set_tried({ file, url });
    try {
      set_tried({ file, url, result: await recognize(file) });
    } catch (error) {
      set_tried(null);
      say_error(error);
    }
  }
  const found = tried?.result;
  return (
    <div class="stack">
      <h1>Try a picture</h1>
      <DropZone title="Drop or paste a picture. It is looked at, not kept." on_files={([file]) => void try_picture(file!)} />
      {tried && (
        <div class="tried">
          <Stage width={found?.width ?? 4} height={found?.height ?? 3} label={tried.file.name}>
            <img src={tried.url} alt={`Picture ${tried.file.name}`} />
            {found && (
              <Overlay
                width={found.width}
                height={found.height}
                detections={found.detections}
                unknown={found.unknown}
                chosen={chosen}
              />
            )}
          </Stage>
          <section class="stack" aria-label="Result" aria-busy={!found}>
            <h2>{found ? (found.detections.length ? "Recognised" : "Nothing recognised") : "Looking …"}</h2>
            {found && (
              <>
                <DetectionList
                  detections={found.detections}
                  unknown={found.unknown}
                  picture={tried.file}
                  on_choose={set_chosen}
                  empty="None of the taught objects was found. Is the object large enough, sharp, and seen from a side that was taught?"
                />
                <div class="row">
                  <WhyNot picture={() => Promise.resolve(tried.file)} />
                </div>
                <Steps result={found} />
              </>
            )}
          </section>
        </div>
      )}
    </div>
  );
}

function Steps({ result: { counts, time_ms } }: { result: Recognition }) {
  const rows: [string, number, number][] = [
    ["Features found", counts.features, time_ms.detect],
    ["Matched with taught ones", counts.matched, time_ms.match],
    ["Agree on a place", counts.clustered, time_ms.vote],
    ["Confirmed", counts.verified, time_ms.verify],
  ];
  return (
    <table class="steps">
      <caption class="hidden-text">What was left after each step, and the time it took</caption>
      <thead>
        <tr>
          <th scope="col">Step</th>
          <th scope="col" class="number">Left</th>
          <th scope="col" class="number">Time</th>
        </tr>
      </thead>
      <tbody>
        {rows.map(([name, left, ms]) => (
          <tr key={name}>
            <th scope="row">{name}</th>
            <td class="number">{left}</td>
            <td class="number">{milliseconds(ms)}</td>
          </tr>
        ))}
      </tbody>
    </table>
  );
}
