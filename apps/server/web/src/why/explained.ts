// What the server says of an object, in the order and the words of the page.
import type { Explanation } from "../api/types";

type Stage = Explanation["stage"];

/// From the picture to the detection.
const kStages: Stage[] = ["features", "similar", "ratio", "votes", "pose", "chance", "object", "place", "competition", "found"];

const rank = ({ stage }: Explanation): number => kStages.indexOf(stage);

/// Those that were not found first, and of them first the one that came farthest: it is the likeliest to be missed.
export function farthest_first(all: Explanation[]): Explanation[] {
  return [...all].sort(
    (a, b) => Number(a.found) - Number(b.found) || rank(b) - rank(a) || b.matched - a.matched || a.object.localeCompare(b.object),
  );
}

export interface Step {
  name: string;
  left: string;
  ended: boolean; // here the evidence was not enough
}

export function steps_of(of: Explanation): Step[] {
  const best = of.best;
  const rows: [string, number | undefined, Stage[]][] = [
    ["Features of the picture", of.scene_features, ["features"]],
    ["Look like one of the object's", of.similar, ["similar"]],
    ["Look more like it than like anything else", of.matched, ["ratio"]],
    ["Most votes for one place and size", of.largest_bin, []],
    ["Places with enough votes", of.clusters, ["votes"]],
    ["Features that agree on the strongest", best?.inliers, ["pose", "chance"]],
  ];
  const steps = rows.map(([name, left, stages]) => ({
    name,
    left: left == null ? "–" : left.toLocaleString("en"),
    ended: stages.includes(of.stage),
  }));
  const probable = best && best.probability > 0 ? `${Math.round(best.probability * 100)} %` : "–";
  steps.push({ name: "How probable it is", left: probable, ended: ["object", "place"].includes(of.stage) });
  steps.push({ name: "Nothing else explains it better", left: of.found ? "yes" : of.stage === "competition" ? "no" : "–", ended: of.stage === "competition" });
  return steps;
}
