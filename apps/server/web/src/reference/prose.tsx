// The little Markdown of openapi.yaml: paragraphs, lists, **bold** and `code`.
import type { ComponentChildren } from "preact";

export function Prose({ text }: { text: string }) {
  return (
    <>
      {text
        .trim()
        .split(/\n\s*\n/)
        .map((block, i) => (
          <Block key={i} text={block} />
        ))}
    </>
  );
}

function Block({ text }: { text: string }) {
  const [before, ...items] = text.split(/^- /m);
  return (
    <>
      {before!.trim() && <p>{inline(before!)}</p>}
      {items.length > 0 && (
        <ul class="ref-list">
          {items.map((item, i) => (
            <li key={i}>{inline(item)}</li>
          ))}
        </ul>
      )}
    </>
  );
}

export function inline(text: string): ComponentChildren[] {
  return text.split(/(\*\*[^*]+\*\*|`[^`]+`)/).map((part, i) => {
    if (part.startsWith("**")) return <b key={i}>{part.slice(2, -2)}</b>;
    if (part.startsWith("`")) return <code key={i}>{part.slice(1, -1)}</code>;
    return part;
  });
}
