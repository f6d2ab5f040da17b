// What was deleted or merged not long ago, with a way back when the message about it is gone.
import { list_deletions, undo } from "../api/calls";
import { objects_version } from "../api/events";
import type { Deletion } from "../api/types";
import { use_loaded } from "../ui/loaded";
import { ago } from "../ui/numbers";
import { attempt } from "../ui/toast";

export function RecentlyDeleted() {
  const { data, reload } = use_loaded(list_deletions, [objects_version.value]);
  if (!data?.deletions.length) return null;
  return (
    <details class="card">
      <summary>Recently deleted ({data.deletions.length})</summary>
      <ul class="deletions">
        {data.deletions.map((one) => (
          <li key={one.undo} class="row spread">
            <span>
              {what(one)} <span class="muted small">{ago(one.age_s)}</span>
            </span>
            <button
              class="button"
              aria-label={`Bring back: ${what(one)}`}
              onClick={() => void attempt(() => undo(one.undo)).then(reload)}
            >
              Bring back
            </button>
          </li>
        ))}
      </ul>
    </details>
  );
}

function what({ object, view, into }: Deletion): string {
  if (into) return `“${object}”, merged into “${into}”`;
  return view ? `A view of “${object}”` : `“${object}”`;
}
