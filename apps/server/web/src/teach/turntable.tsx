// Teaching by turning the object before a camera: background, then side by side round the ring.
import { useEffect, useState } from "preact/hooks";
import { ActionButton } from "../ui/action_button";
import { sentence } from "../ui/numbers";
import { attempt } from "../ui/toast";
import { ProposalMask } from "./proposal_mask";
import { Ring } from "./ring";
import { idle_sides, kTurnDeg, sides_of, type Teaching } from "./teaching";
import { Verdict } from "./verdict";

interface Props {
  teaching: Teaching;
  ready: boolean;  // the camera gives pictures
  grab?: () => Promise<Blob>;  // none: the server's own camera
}

const kPauseMs = 200;

export function Turntable({ teaching, ready, grab }: Props) {
  const session = teaching.session.value;
  const proposal = teaching.proposal.value;
  const background = session?.background ?? false;
  const [correcting, set_correcting] = useState(false);
  const [taking_background, set_taking_background] = useState(false);
  const busy = teaching.taking.value || taking_background;
  use_looking(teaching, grab, ready && background && !busy && !correcting);

  async function take_background(): Promise<void> {
    set_taking_background(true);
    await attempt(async () => teaching.take_background(await grab?.()));
    set_taking_background(false);
  }
  async function correct(): Promise<void> {
    await teaching.settled();
    set_correcting(true);
  }
  const take = (): Promise<boolean> => attempt(async () => teaching.take({ picture: await grab?.() }));
  const views = session?.views ?? [];
  return (
    <div class="stack turntable">
      <div class="turntable-step">
        <Instruction step={!background ? 0 : views.length === 0 ? 1 : session!.enough ? 3 : 2} />
        {background && (
          <Ring
            yaws={sides_of(session!)}
            idle={idle_sides(session!)}
            reach_deg={kTurnDeg / 2}
            chosen={teaching.yaw.value ?? 0}
            on_choose={(yaw) => (teaching.yaw.value = yaw)}
          />
        )}
      </div>
      <div class="stack tight turntable-act">
        {background && <Verdict teaching={teaching} waiting="Looking for the object …" />}
        <ActionButton
          can={ready && !busy && (!background || proposal?.usable === true)}
          on_click={() => void (background ? take() : take_background())}
        >
          {background ? "Take this view" : "The table is empty"}
        </ActionButton>
      </div>
      {background && (
        <div class="row">
          <button class="button" disabled={!proposal || busy} onClick={() => void correct()}>
            Correct mask
          </button>
          <button class="button plain" disabled={busy} onClick={() => void take_background()}>
            New background
          </button>
        </div>
      )}
      {correcting && (
        <ProposalMask
          teaching={teaching}
          on_corrected={async () => {
            const { usable, advice } = teaching.proposal.value!;
            if (!usable) throw new Error(sentence(advice[0] ?? "nothing can be learned from this"));
            await teaching.accept();
          }}
          on_close={() => set_correcting(false)}
        />
      )}
    </div>
  );
}

const kSteps = [
  ["Clear the table", "Take the object out of the picture and leave the camera where it is."],
  ["Put the object down", "Its whole front in the picture, hands away. The bright part is what will be learned."],
  ["Turn it a little", `About ${kTurnDeg}°, a twelfth of a turn, always the same way round. Save as soon as you like.`],
  ["All sides are covered", "That is enough. Give it a name and save."],
] as const;

function Instruction({ step }: { step: number }) {
  const [title, text] = kSteps[step]!;
  return (
    <div class="instruction" aria-live="polite">
      <h2>
        {Math.min(step + 1, 3)}. {title}
      </h2>
      <p class="muted">{text}</p>
    </div>
  );
}

/// Asks again and again what would be taken, while `active`.
function use_looking(teaching: Teaching, grab: Props["grab"], active: boolean): void {
  useEffect(() => {
    if (!active) return;
    let looking = true;
    void (async () => {
      while (looking) {
        await grab_and_look(teaching, grab);
        await new Promise((done) => setTimeout(done, kPauseMs));
      }
    })();
    return () => {
      looking = false;
    };
  }, [active]);
}

async function grab_and_look(teaching: Teaching, grab: Props["grab"]): Promise<void> {
  try {
    await teaching.look({ picture: await grab?.() });
  } catch {
    // The verdict tells it from `teaching.trouble`.
  }
}
