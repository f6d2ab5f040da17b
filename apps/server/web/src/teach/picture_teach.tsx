// Teaching from pictures: one after the other, the object found by the way that is chosen.
import { useEffect, useState } from "preact/hooks";
import { ActionButton } from "../ui/action_button";
import { DropZone } from "../ui/drop_zone";
import { Stage } from "../ui/stage";
import { attempt, say } from "../ui/toast";
import type { Box } from "./box";
import { BoxEditor } from "./box_editor";
import { is_background_name, read_pictures, yaw_of_name, type Waiting } from "./pictures";
import { ProposalMask } from "./proposal_mask";
import { SilhouetteOverlay } from "./silhouette_overlay";
import type { Teaching } from "./teaching";
import { Verdict } from "./verdict";
import { WayChoice, type Way } from "./way_choice";
import "./picture_teach.css";

const kSettleMs = 300; // a box is being drawn

export function PictureTeach({ teaching }: { teaching: Teaching }) {
  const [waiting, set_waiting] = useState<Waiting[]>([]);
  const [way, set_way] = useState<Way>("whole");
  const [box, set_box] = useState<Box | null>(null);
  const [correcting, set_correcting] = useState(false);
  const session = teaching.session.value;
  const proposal = teaching.proposal.value;
  const now = waiting[0];
  const asking = now && (way !== "box" || box) && {
    picture: now.file,
    whole: way === "whole" || undefined,
    roi: way === "box" && box ? [box.x, box.y, box.width, box.height].join(",") : undefined,
  };

  useEffect(() => {
    teaching.proposal.value = null;
    if (!asking || correcting) return;
    const timer = setTimeout(() => void attempt(() => teaching.look(asking)), kSettleMs);
    return () => clearTimeout(timer);
  }, [now, way, box]);

  useEffect(() => {
    if (now) teaching.yaw.value = yaw_of_name(now.file.name);
  }, [now]);

  const next = (): void => {
    URL.revokeObjectURL(now!.url);
    set_box(null);
    set_waiting((all) => all.slice(1));
  };
  const take = async (): Promise<void> => {
    await teaching.accept();
    next();
  };
  const use_as_background = (file: File): Promise<boolean> =>
    attempt(async () => {
      await teaching.take_background(file);
      set_way("background");
      say(`“${file.name}” is the picture without the object.`);
    });
  const add = (files: File[]): Promise<boolean> =>
    attempt(async () => {
      const empty = files.find((file) => is_background_name(file.name));
      if (empty) await use_as_background(empty);
      const read = await read_pictures(files.filter((file) => file !== empty));
      set_waiting((all) => [...all, ...read]);
    });

  if (!now)
    return (
      <DropZone
        multiple
        title="Drop pictures of one object here: a cover, or its sides. A picture of the empty table helps to find it."
        on_files={(files) => void add(files)}
      />
    );
  return (
    <div class="picture-teach">
      {way === "box" ? (
        <BoxEditor picture={now.url} width={now.width} height={now.height} box={box} on_change={set_box} />
      ) : (
        <Stage width={now.width} height={now.height} label={now.file.name}>
          <img src={now.url} alt={`Picture ${now.file.name}`} />
          <SilhouetteOverlay of={proposal} />
        </Stage>
      )}
      <div class="stack">
        <p class="muted small">
          {now.file.name} · {waiting.length - 1} more waiting
        </p>
        <WayChoice way={way} has_background={session?.background ?? false} on_choose={set_way} />
        <label class="field">
          <span class="label">Side, in degrees</span>
          <input
            class="input"
            type="number"
            min={0}
            max={359}
            placeholder="not known"
            value={teaching.yaw.value ?? ""}
            onChange={(event) => (teaching.yaw.value = event.currentTarget.value === "" ? null : event.currentTarget.valueAsNumber)}
          />
        </label>
        <Verdict teaching={teaching} waiting={way === "box" && !box ? "Draw a box around the object." : "Looking …"} />
        <ActionButton can={proposal?.usable === true && !teaching.taking.value} on_click={() => void attempt(take)}>
          Take this view
        </ActionButton>
        <div class="row">
          <button class="button" disabled={!proposal} onClick={() => set_correcting(true)}>
            Correct the mask
          </button>
          <button class="button plain" onClick={next}>
            Skip
          </button>
          <button class="button plain" onClick={() => void use_as_background(now.file).then((ok) => ok && next())}>
            This is the empty table
          </button>
        </div>
      </div>
      {correcting && <ProposalMask teaching={teaching} on_close={() => set_correcting(false)} />}
    </div>
  );
}
