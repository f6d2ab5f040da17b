// How fast it goes, one line under the picture; columns keep their width.
import { live, result } from "../api/events";
import { milliseconds } from "../ui/numbers";

export function Rates() {
  const state = live.value;
  const newest = result.value;
  const shown: [string, string][] = [
    ["Camera", state ? `${state.source_fps.toFixed(1)} fps` : "–"],
    ["Recognition", state ? `${state.recognized_fps.toFixed(1)} fps` : "–"],
    ["Time", newest ? milliseconds(newest.time_ms.total) : "–"],
    ["Features", newest ? String(newest.counts.features) : "–"],
  ];
  return (
    <dl class="rates">
      {shown.map(([name, value]) => (
        <div key={name}>
          <dt>{name}</dt>
          <dd>{value}</dd>
        </div>
      ))}
    </dl>
  );
}
