// One object: its views, and what can be done with it.
import { useState } from "preact/hooks";
import { delete_object, delete_view, export_link, get_object, view_thumbnail } from "../api/calls";
import { ApiError } from "../api/client";
import { objects_version } from "../api/events";
import type { ViewSummary } from "../api/types";
import { go_to, link_to } from "../router";
import { use_loaded } from "../ui/loaded";
import { count, degrees } from "../ui/numbers";
import { Failed, State, Waiting } from "../ui/state";
import { attempt } from "../ui/toast";
import { MergeDialog } from "./merge_dialog";
import { RenameDialog } from "./rename_dialog";
import { do_with_undo } from "./undo";
import { ViewDialog } from "./view_dialog";

export function ObjectPage({ name }: { name: string }) {
  const { data, error, reload } = use_loaded((signal) => get_object(name, signal), [name, objects_version.value]);
  const [asking, set_asking] = useState<"rename" | "merge" | null>(null);
  const [view, set_view] = useState<ViewSummary | null>(null);
  if (error instanceof ApiError && error.status === 404)
    return (
      <State icon="◇" title={`There is no “${name}”`} alert>
        <p>{error.message}</p>
        <a class="button" href={link_to("objects")}>
          All objects
        </a>
      </State>
    );
  if (error && !data) return <Failed what="object" error={error} on_retry={reload} />;
  if (!data) return <Waiting what={name} />;

  const remove = async (): Promise<void> => {
    await do_with_undo(delete_object(name), `“${name}” is deleted.`, () => go_to("objects", name));
    go_to("objects");
  };
  const remove_view = async ({ view: id }: ViewSummary): Promise<void> => {
    set_view(null);
    await do_with_undo(delete_view(name, id), "The view is deleted.");
    if (data.views.length === 1) go_to("objects");
  };
  return (
    <div class="stack">
      <nav class="small">
        <a href={link_to("objects")}>← All objects</a>
      </nav>
      <header class="row spread">
        <h1>{name}</h1>
        <div class="row">
          <a class="button primary" href={link_to("teach", name)}>
            Add views
          </a>
          <button class="button" onClick={() => set_asking("rename")}>
            Rename
          </button>
          <button class="button" onClick={() => set_asking("merge")}>
            Merge
          </button>
          <a class="button" href={export_link(name)} download={`${name}.posevote`}>
            Export
          </a>
          <button class="button danger" onClick={() => void attempt(remove)}>
            Delete
          </button>
        </div>
      </header>
      <p class="muted">
        {count(data.views.length, "view")}.{" "}
        {data.next_yaw != null && `The next picture helps most from ${degrees(data.next_yaw)}.`}
      </p>
      <ul class="views">
        {data.views.map((taught) => (
          <li key={taught.view}>
            <button class="object view" onClick={() => set_view(taught)}>
              <img src={view_thumbnail(name, taught.view)} alt="" loading="lazy" />
              <b>{taught.yaw == null ? `View ${taught.view}` : degrees(taught.yaw)}</b>
              <span class="muted small">{count(taught.features, "feature")}</span>
            </button>
          </li>
        ))}
      </ul>
      {asking === "rename" && <RenameDialog name={name} on_close={() => set_asking(null)} />}
      {asking === "merge" && <MergeDialog name={name} on_close={() => set_asking(null)} />}
      {view && (
        <ViewDialog
          key={view.view}
          object={name}
          view={view}
          on_delete={() => void attempt(() => remove_view(view))}
          on_close={() => set_view(null)}
        />
      )}
    </div>
  );
}
