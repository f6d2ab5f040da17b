// The ring of sides: done, done by a view that adds little, the one to take next, and missing ones;
// each can be chosen.
import { covered, sector_path } from "./sides";
import { degrees } from "../ui/numbers";
import "./ring.css";

interface Props {
  yaws: number[];
  idle: number[];  // those of which the views add little
  reach_deg: number;
  chosen: number;  // side that the next view is of
  on_choose: (yaw: number) => void;
}

const kSectors = 12;
const kStep = 360 / kSectors;

export function Ring({ yaws, idle, reach_deg, chosen, on_choose }: Props) {
  const done = covered(yaws, reach_deg, kSectors);
  const adds_little = covered(idle, reach_deg, kSectors);
  const sides = done.filter(Boolean).length;
  return (
    <div class="ring">
      <svg viewBox="-54 -54 108 108" role="radiogroup" aria-label="Side of the object for the next view">
        {done.map((is_done, i) => {
          const yaw = i * kStep;
          const is_next = yaw === chosen;
          const choose = (step: number): void => on_choose(((i + step + kSectors) % kSectors) * kStep);
          return (
            <path
              key={i}
              class={`side${is_done ? " done" : ""}${adds_little[i] ? " idle" : ""}${is_next ? " next" : ""}`}
              d={sector_path(yaw - kStep / 2 + 1.5, yaw + kStep / 2 - 1.5, 32, 50)}
              role="radio"
              tabindex={is_next ? 0 : -1}
              aria-checked={is_next}
              aria-label={`${degrees(yaw)}, ${adds_little[i] ? "covered, its view adds little" : is_done ? "covered" : "missing"}`}
              onClick={() => on_choose(yaw)}
              onKeyDown={(event) => {
                const step = { ArrowRight: 1, ArrowUp: 1, ArrowLeft: -1, ArrowDown: -1 }[event.key];
                if (!step) return;
                event.preventDefault();
                choose(step);
                const ring = event.currentTarget.parentElement!;
                (ring.children[(i + step + kSectors) % kSectors] as SVGElement).focus();
              }}
            />
          );
        })}
        <text class="ring-count" y="2" aria-hidden="true">
          {sides}/{kSectors}
        </text>
        <text class="ring-word" y="14" aria-hidden="true">
          sides
        </text>
      </svg>
    </div>
  );
}
