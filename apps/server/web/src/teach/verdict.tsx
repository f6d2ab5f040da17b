// Is what is seen now good enough? One sentence, in a place that keeps its height.
import { useMemo } from "preact/hooks";
import type { Proposal } from "../api/types";
import { Announcement } from "../ui/announcement";
import { count, sentence } from "../ui/numbers";
import type { Teaching } from "./teaching";
import "./verdict.css";

interface Props {
  teaching: Teaching;
  waiting: string;
}

export function Verdict({ teaching, waiting }: Props) {
  const trouble = teaching.trouble.value;
  const [kind, text] = trouble ? ["bad", trouble] : judge(teaching.proposal.value, waiting);
  const announced = useMemo(() => text, [kind]); // not every number that changes with every look
  return (
    <div>
      <div class={`note verdict ${kind}`}>{text}</div>
      <Announcement text={announced!} />
    </div>
  );
}

function judge(proposal: Proposal | null, waiting: string): [string, string] {
  if (!proposal) return ["", waiting];
  if (!proposal.usable) return ["bad", sentence(proposal.advice[0] ?? "the object was not found")];
  if (proposal.adds_little) return ["warn", "This side is known already: turn the object on. The view would add little."];
  const features = count(proposal.features, "feature");
  const [advice] = proposal.advice;
  return ["good", `Good: ${features} found. ${advice ? sentence(advice) : ""}`];
}
