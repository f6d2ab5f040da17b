// Objects from an exported file; what happens to names that are there already is asked first.
import { useState } from "preact/hooks";
import { import_objects } from "../api/calls";
import { Dialog } from "../ui/dialog";
import { count } from "../ui/numbers";
import { use_problem } from "../ui/problem";
import { say } from "../ui/toast";

const kChoices = [
  ["merge", "Add the views to the object that is there"],
  ["replace", "Replace the object that is there"],
  ["refuse", "Import nothing if a name is taken"],
] as const;

export function ImportDialog({ file, on_close }: { file: File; on_close: () => void }) {
  const [existing, set_existing] = useState<string>("merge");
  const [sure, set_sure] = useState(false);
  const problem = use_problem();
  async function run(): Promise<void> {
    const { objects, views_added, views_known } = await import_objects(file, existing);
    const known = views_known ? `, ${views_known} known already` : "";
    say(`Imported ${count(objects, "object")}: ${count(views_added, "new view")}${known}.`);
    on_close();
  }
  return (
    <Dialog title={`Import ${file.name}`} on_close={on_close}>
      <fieldset class="stack tight">
        <legend class="label">If a name is taken</legend>
        {kChoices.map(([value, label]) => (
          <label key={value} class="choice">
            <input
              type="radio"
              name="existing"
              checked={existing === value}
              onChange={() => {
                set_existing(value);
                set_sure(false);
              }}
            />
            {label}
          </label>
        ))}
      </fieldset>
      {existing === "replace" && (
        <label class="choice note warn">
          <input type="checkbox" checked={sure} onChange={(event) => set_sure(event.currentTarget.checked)} />
          What is replaced is lost: this cannot be undone.
        </label>
      )}
      {problem.shown}
      <button
        class="button primary"
        disabled={problem.busy || (existing === "replace" && !sure)}
        onClick={() => void problem.run(run)}
      >
        {problem.busy ? "Importing …" : "Import"}
      </button>
    </Dialog>
  );
}
