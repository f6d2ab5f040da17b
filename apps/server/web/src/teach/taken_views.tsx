// The views taken so far; each can be taken out again.
import { session_view_thumbnail } from "../api/calls";
import { degrees } from "../ui/numbers";
import { attempt, say } from "../ui/toast";
import type { Teaching } from "./teaching";
import "./taken_views.css";

export function TakenViews({ teaching }: { teaching: Teaching }) {
  const session = teaching.session.value;
  if (!session?.views.length) return null;
  const take_out = async (view: string, side: string): Promise<void> => {
    await teaching.remove(view);
    say(`View ${side} is taken out.`, { label: "Undo", run: () => void attempt(() => teaching.restore(view)) });
  };
  return (
    <ul class="taken" aria-label="Views taken">
      {session.views.map((view) => {
        const side = view.yaw == null ? "view" : degrees(view.yaw);
        return (
          <li key={view.view} class="taken-view">
            <img src={session_view_thumbnail(session.session, view.view)} alt={`View ${side}`} width={88} height={66} />
            <span class="small">
              {side}
              {view.adds_little && <span class="taken-mark">adds little</span>}
            </span>
            <button
              class="button plain"
              aria-label={`Take out view ${side}`}
              onClick={() => void attempt(() => take_out(view.view, side))}
            >
              ✕
            </button>
          </li>
        );
      })}
    </ul>
  );
}
