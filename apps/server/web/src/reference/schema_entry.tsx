// Types and properties in words, with links to the schemas that they name.
import api from "virtual:openapi";
import { link_to } from "../router";
import { properties_of, type_text, type Schema } from "./description";
import { inline, Prose } from "./prose";

export function Type({ of }: { of: Schema }) {
  const { before, ref, after } = type_text(of);
  return (
    <span class="ref-type">
      {before}
      {ref && <a href={link_to("api", ref)}>{ref}</a>}
      {after}
    </span>
  );
}

export function Properties({ of }: { of: Schema }) {
  return (
    <dl class="ref-rows">
      {properties_of(api, of).map(({ name, schema, required }) => (
        <div key={name}>
          <dt>
            <code>{name}</code> {!required && <span class="muted small">may be missing</span>}
          </dt>
          <dd>
            <Type of={schema} /> {schema.description && inline(schema.description)}
            {schema.properties && <Properties of={schema} />}
          </dd>
        </div>
      ))}
    </dl>
  );
}

export function SchemaEntry({ name, schema }: { name: string; schema: Schema }) {
  return (
    <details id={`ref-${name}`} class="ref-entry">
      <summary>
        <code class="ref-path">{name}</code>
        {!schema.properties && !schema.allOf && <span class="muted">{schema.description}</span>}
      </summary>
      <div class="stack ref-body">
        {schema.properties || schema.allOf ? (
          <Properties of={schema} />
        ) : (
          <p>
            <Type of={schema} />
          </p>
        )}
        {schema.description && <Prose text={schema.description} />}
      </div>
    </details>
  );
}
