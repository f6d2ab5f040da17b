// The name, and Save. A name that is there already takes the views only when that is wanted.
import { useId, useState } from "preact/hooks";
import { ApiError } from "../api/client";
import type { Saved } from "../api/types";
import { count } from "../ui/numbers";
import { say_error } from "../ui/toast";
import type { Teaching } from "./teaching";

interface Props {
  teaching: Teaching;
  name: string;
  on_saved: (saved: Saved) => void;
}

export function SaveForm({ teaching, name: given, on_saved }: Props) {
  const [name, set_name] = useState(given);
  const [taken, set_taken] = useState(given !== "");
  const [saving, set_saving] = useState(false);
  const input = useId();
  const views = teaching.session.value?.views.length ?? 0;

  async function save(event: Event): Promise<void> {
    event.preventDefault();
    set_saving(true);
    try {
      on_saved(await teaching.save(name.trim(), taken));
    } catch (error) {
      if (error instanceof ApiError && error.code === "already_exists") set_taken(true);
      else say_error(error);
    }
    set_saving(false);
  }

  return (
    <form class="stack tight" onSubmit={(event) => void save(event)}>
      <div class="field">
        <label htmlFor={input}>Name</label>
        <input
          id={input}
          class="input"
          required
          maxLength={200}
          autocomplete="off"
          placeholder="e.g. red mug"
          value={name}
          onInput={(event) => {
            set_name(event.currentTarget.value);
            set_taken(given !== "" && event.currentTarget.value === given);
          }}
        />
      </div>
      {taken && (
        <p class="note warn small" role="status">
          There is an object “{name.trim()}” already. Saving adds these views to it.
        </p>
      )}
      <button class="button primary" disabled={views === 0 || !name.trim() || saving}>
        {taken ? "Add to it" : "Save"} {views > 0 && `(${count(views, "view")})`}
      </button>
    </form>
  );
}
