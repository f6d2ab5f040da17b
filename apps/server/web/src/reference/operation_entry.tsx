// One operation: closed a line, open all that there is to know.
import { access } from "../api/client";
import { curl, type Content, type Operation } from "./description";
import { inline, Prose } from "./prose";
import { Properties, Type } from "./schema_entry";

export function OperationEntry({ operation }: { operation: Operation }) {
  const { id, method, path, summary, description, open, parameters, body, responses } = operation;
  return (
    <details id={`ref-${id}`} class="ref-entry">
      <summary>
        <span class={`ref-method ${method.toLowerCase()}`}>{method}</span>
        <code class="ref-path">{path}</code>
        <span class="muted">{inline(summary)}</span>
      </summary>
      <div class="stack ref-body">
        <Prose text={description} />
        {open && <p class="muted small">Needs no token.</p>}
        {parameters.length > 0 && (
          <section class="stack tight">
            <h3>Parameters</h3>
            <dl class="ref-rows">
              {parameters.map((one) => (
                <div key={one.name}>
                  <dt>
                    <code>{one.name}</code> <span class="muted small">{one.in}</span>
                  </dt>
                  <dd>
                    <Type of={one.schema} /> {one.description && inline(one.description)}
                  </dd>
                </div>
              ))}
            </dl>
          </section>
        )}
        {body && (
          <section class="stack tight">
            <h3>Body{body.required ? "" : ", may be empty"}</h3>
            {body.description && <p>{inline(body.description)}</p>}
            <Contents of={body} />
          </section>
        )}
        <section class="stack tight">
          <h3>Answers</h3>
          <dl class="ref-rows">
            {responses.map(([status, response]) => (
              <div key={status}>
                <dt>
                  <span class={`tag ${status < "400" ? "good" : "warn"}`}>{status}</span>
                </dt>
                <dd class="stack tight">
                  <span>{inline(response.description ?? "")}</span>
                  {status < "400" && <Contents of={response} />}
                </dd>
              </div>
            ))}
          </dl>
        </section>
        <section class="stack tight">
          <h3>In a terminal</h3>
          <code class="ref-curl">{curl(operation, location.origin, access.value?.token_needed ?? false)}</code>
        </section>
      </div>
    </details>
  );
}

function Contents({ of }: { of: Content }) {
  return (
    <>
      {Object.entries(of.content ?? {}).map(([type, { schema }]) => (
        <div key={type} class="stack tight">
          <span>
            <code>{type}</code> {type.endsWith("json") && !schema.properties && <Type of={schema} />}
          </span>
          {schema.properties && <Properties of={schema} />}
        </div>
      ))}
    </>
  );
}
