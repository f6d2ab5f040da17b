// Views of a session that was left: go on, or throw them away.
import { discard_session, list_sessions } from "../api/calls";
import type { TeachSession } from "../api/types";
import { use_loaded } from "../ui/loaded";
import { clock, count } from "../ui/numbers";
import { attempt } from "../ui/toast";

export function Resume({ on_resume }: { on_resume: (session: TeachSession) => void }) {
  const { data, reload } = use_loaded(list_sessions, []);
  const left = data?.sessions.filter((session) => session.views.length > 0) ?? [];
  return (
    <>
      {left.map((session) => (
        <div key={session.session} class="note warn row spread">
          <span>
            {session.object ? `More of “${session.object}”` : "An object without a name yet"}:{" "}
            {count(session.views.length, "view")}, begun {clock(session.seconds * 1000)} ago and not saved.
          </span>
          <span class="row">
            <button class="button" onClick={() => on_resume(session)}>
              Go on with it
            </button>
            <button
              class="button plain"
              onClick={() => void attempt(() => discard_session(session.session)).then(reload)}
            >
              Discard
            </button>
          </span>
        </div>
      ))}
    </>
  );
}
