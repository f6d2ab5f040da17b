// Is this view good enough to be recognised by? In numbers and in words.
import type { Quality } from "../api/types";
import { percent, sentence } from "../ui/numbers";

const pixels = (value: number | null): string => (value == null ? "–" : `${Math.round(value)} px`);

export function QualityCard({ quality, problem }: { quality?: Quality; problem?: string }) {
  if (problem) return <p class="note bad">{problem}</p>;
  const rows: [string, string][] = [
    ["Features", quality ? String(quality.features) : "…"],
    ["Parts of it that have features", quality ? percent(quality.coverage) : "…"],
    ["Looks alike in several places", quality ? percent(quality.self_similarity) : "…"],
    ["Known from its other views", quality ? percent(quality.redundancy) : "…"],
    ["Size in the picture", quality ? pixels(quality.size_px) : "…"],
    ["Smallest size to be recognised", quality ? pixels(quality.smallest_size_px) : "…"],
  ];
  return (
    <section class="stack tight" aria-label="Quality" aria-busy={!quality}>
      <dl class="quality">
        {rows.map(([name, value]) => (
          <>
            <dt>{name}</dt>
            <dd>{value}</dd>
          </>
        ))}
      </dl>
      {quality &&
        (quality.advice.length === 0 ? (
          <p class="note good">A good view.</p>
        ) : (
          quality.advice.map((advice) => (
            <p key={advice} class="note warn">
              {sentence(advice)}
            </p>
          ))
        ))}
    </section>
  );
}
