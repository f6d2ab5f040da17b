// All views into another object: for a thing that was taught under two names.
import { useState } from "preact/hooks";
import { list_objects, merge_object } from "../api/calls";
import { go_to } from "../router";
import { Dialog } from "../ui/dialog";
import { use_loaded } from "../ui/loaded";
import { use_problem } from "../ui/problem";
import { do_with_undo } from "./undo";

export function MergeDialog({ name, on_close }: { name: string; on_close: () => void }) {
  const { data } = use_loaded(list_objects, []);
  const others = (data?.objects ?? []).map(({ object }) => object).filter((object) => object !== name);
  const [into, set_into] = useState("");
  const problem = use_problem();
  async function merge(): Promise<void> {
    const back = (): void => go_to("objects", name);
    await do_with_undo(merge_object(name, into), `“${name}” is now part of “${into}”.`, back);
    on_close();
    go_to("objects", into);
  }
  return (
    <Dialog title={`Merge “${name}”`} on_close={on_close}>
      <form
        class="stack"
        onSubmit={(event) => {
          event.preventDefault();
          void problem.run(merge);
        }}
      >
        <p class="muted">All its views move into the other object; the name “{name}” goes away.</p>
        <label class="field">
          <span class="label">Into</span>
          <select class="input" required value={into} onChange={(event) => set_into(event.currentTarget.value)}>
            <option value="" disabled>
              {data && others.length === 0 ? "There is no other object" : "Choose an object"}
            </option>
            {others.map((object) => (
              <option key={object}>{object}</option>
            ))}
          </select>
        </label>
        {problem.shown}
        <button class="button primary" disabled={!into || problem.busy}>
          Merge
        </button>
      </form>
    </Dialog>
  );
}
