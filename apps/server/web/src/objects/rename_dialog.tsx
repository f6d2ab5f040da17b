// Another name.
import { useState } from "preact/hooks";
import { rename_object } from "../api/calls";
import { go_to } from "../router";
import { Dialog } from "../ui/dialog";
import { use_problem } from "../ui/problem";
import { attempt, say } from "../ui/toast";

export function RenameDialog({ name, on_close }: { name: string; on_close: () => void }) {
  const [wanted, set_wanted] = useState(name);
  const problem = use_problem();
  async function rename(): Promise<void> {
    const { object } = await rename_object(name, wanted.trim());
    on_close();
    go_to("objects", object);
    say(`“${name}” is now called “${object}”.`, {
      label: "Undo",
      run: () => void attempt(async () => go_to("objects", (await rename_object(object, name)).object)),
    });
  }
  return (
    <Dialog title={`Rename “${name}”`} on_close={on_close}>
      <form
        class="stack"
        onSubmit={(event) => {
          event.preventDefault();
          void problem.run(rename);
        }}
      >
        <label class="field">
          <span class="label">New name</span>
          <input
            class="input"
            autofocus
            maxLength={200}
            value={wanted}
            onInput={(event) => {
              set_wanted(event.currentTarget.value);
              problem.forget();
            }}
          />
        </label>
        {problem.shown}
        <button class="button primary" disabled={!wanted.trim() || wanted.trim() === name || problem.busy}>
          Rename
        </button>
      </form>
    </Dialog>
  );
}
