// The HTTP interface for people: openapi.yaml, as it was when this page was built.
import api from "virtual:openapi";
import { useEffect } from "preact/hooks";
import { operations_of } from "./description";
import { OperationEntry } from "./operation_entry";
import { Prose } from "./prose";
import { SchemaEntry } from "./schema_entry";
import "./reference.css";

/// `wanted`: id of an operation or name of a schema to open.
export function ReferencePage({ wanted }: { wanted: string }) {
  useEffect(() => open_entry(wanted), [wanted]);
  return (
    <div class="stack reference">
      <header class="row spread">
        <h1>HTTP interface</h1>
        <a class="button" href="/api/openapi.yaml" download="openapi.yaml">
          openapi.yaml
        </a>
      </header>
      <section class="card stack" aria-label="About">
        <Prose text={api.info.description} />
      </section>
      {api.tags.map(({ name, description }) => (
        <section key={name} class="card stack tight" aria-label={description}>
          <h2>{description}</h2>
          <div>
            {operations_of(api, name).map((operation) => (
              <OperationEntry key={operation.id} operation={operation} />
            ))}
          </div>
        </section>
      ))}
      <section class="card stack tight" aria-label="What is sent and answered">
        <h2>What is sent and answered</h2>
        <div>
          {Object.entries(api.components.schemas).map(([name, schema]) => (
            <SchemaEntry key={name} name={name} schema={schema} />
          ))}
        </div>
      </section>
    </div>
  );
}

function open_entry(id: string): void {
  const entry = id && document.getElementById(`ref-${id}`);
  if (!entry) return;
  entry.setAttribute("open", "");
  entry.scrollIntoView();
  entry.querySelector("summary")!.focus({ preventScroll: true });
}
