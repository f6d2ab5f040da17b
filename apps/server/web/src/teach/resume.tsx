// Views of a session that was left: go on, or throw them away.
import { discard_session, list_sessions } from "../api/calls";
import type { TeachSession } from "../api/types";
import { AskFirst } from "../ui/ask_first";
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
            <AskFirst
              label="Discard"
              title="Discard these views?"
              text={`${count(session.views.length, "view")} will be lost.`}
              keep="Keep them"
              on_sure={() => void attempt(() => discard_session(session.session)).then(reload)}
            />
          </span>
        </div>
      ))}
    </>
  );
}
