// Another name.
import { useState } from "preact/hooks";
import { rename_object } from "../api/calls";
import { go_to } from "../router";
import { Dialog } from "../ui/dialog";

export function RenameDialog({ name, on_close }: { name: string; on_close: () => void }) {
  const [wanted, set_wanted] = useState(name);
  const [problem, set_problem] = useState("");
  async function rename(event: Event): Promise<void> {
    event.preventDefault();
    try {
      const { object } = await rename_object(name, wanted.trim());
      on_close();
      go_to("objects", object);
    } catch (error) {
      set_problem((error as Error).message);
    }
  }
  return (
    <Dialog title={`Rename “${name}”`} on_close={on_close}>
      <form class="stack" onSubmit={(event) => void rename(event)}>
        <label class="field">
          <span class="label">New name</span>
          <input
            class="input"
            autofocus
            maxLength={200}
            value={wanted}
            aria-describedby="rename-problem"
            onInput={(event) => {
              set_wanted(event.currentTarget.value);
              set_problem("");
            }}
          />
        </label>
        <p id="rename-problem" class="note bad small" role="alert" hidden={!problem}>
          {problem}
        </p>
        <button class="button primary" disabled={!wanted.trim() || wanted.trim() === name}>
          Rename
        </button>
      </form>
    </Dialog>
  );
}
