// All that was taught.
import { useRef, useState } from "preact/hooks";
import { export_link, list_objects, view_thumbnail } from "../api/calls";
import { objects_version } from "../api/events";
import { link_to } from "../router";
import { use_loaded } from "../ui/loaded";
import { count } from "../ui/numbers";
import { Failed, State, Waiting } from "../ui/state";
import { ImportDialog } from "./import_dialog";
import { RecentlyDeleted } from "./recently_deleted";
import "./objects_page.css";

export function ObjectsPage() {
  const { data, error, reload } = use_loaded(list_objects, [objects_version.value]);
  const [sought, set_sought] = useState("");
  const [file, set_file] = useState<File | null>(null);
  const chooser = useRef<HTMLInputElement>(null);
  const all = data?.objects ?? [];
  const shown = all.filter(({ object }) => object.toLowerCase().includes(sought.toLowerCase()));
  return (
    <div class="stack">
      <header class="row spread">
        <h1>Objects</h1>
        <div class="row">
          <button class="button" onClick={() => chooser.current!.click()}>
            Import
          </button>
          <input
            ref={chooser}
            id="import-file"
            type="file"
            hidden
            onChange={(event) => {
              set_file(event.currentTarget.files?.[0] ?? null);
              event.currentTarget.value = "";
            }}
          />
          {all.length > 0 && (
            <a class="button" href={export_link()} download="objects.posevote">
              Export all
            </a>
          )}
        </div>
      </header>
      {all.length > 6 && (
        <input
          class="input objects-search"
          type="search"
          aria-label="Search by name"
          placeholder="Search by name"
          value={sought}
          onInput={(event) => set_sought(event.currentTarget.value)}
        />
      )}
      {error && !data ? (
        <Failed what="objects" error={error} on_retry={reload} />
      ) : !data ? (
        <Waiting what="objects" />
      ) : all.length === 0 ? (
        <State icon="◇" title="Nothing taught yet">
          <p>Teach an object with the camera or from pictures, or import a file that was exported elsewhere.</p>
          <a class="button primary" href={link_to("teach")}>
            New object
          </a>
        </State>
      ) : (
        <ul class="objects">
          {shown.map(({ object, views, features, cover }) => (
            <li key={object}>
              <a class="object" href={link_to("objects", object)}>
                {cover ? <img src={view_thumbnail(object, cover)} alt="" loading="lazy" /> : <span class="object-blank" />}
                <b>{object}</b>
                <span class="muted small">
                  {count(views, "view")} · {count(features, "feature")}
                </span>
              </a>
            </li>
          ))}
        </ul>
      )}
      {data && all.length > 0 && shown.length === 0 && <p class="muted">No object is called “{sought}”.</p>}
      {data && <RecentlyDeleted />}
      {file && <ImportDialog file={file} on_close={() => set_file(null)} />}
    </div>
  );
}
