// The server's picture of matches and votes: its two halves, beside or below one another.
import { useEffect, useState } from "preact/hooks";
import { use_loaded } from "../ui/loaded";

interface Props {
  load: (signal: AbortSignal) => Promise<Blob>;
  width: number; // of one half
  height: number;
  object: string;
}

const kHalves = [
  { side: "left", text: "Features that match it, and where it would be" },
  { side: "right", text: "Votes for its centre: the brighter, the more" },
];

export function Evidence({ load, width, height, object }: Props) {
  const { data, error } = use_loaded(load, []);
  const [url, set_url] = useState("");
  useEffect(() => {
    if (!data) return;
    const made = URL.createObjectURL(data);
    set_url(made);
    return () => URL.revokeObjectURL(made);
  }, [data]);
  if (error) return <p class="note bad">{error.message}</p>;
  return (
    <div class="why-evidence" aria-busy={!url}>
      {kHalves.map(({ side, text }) => (
        <figure key={side}>
          <div class="why-half" style={{ aspectRatio: `${width} / ${height}` }}>
            {url && <img class={side} src={url} alt={`${text}: ${object}`} />}
          </div>
          <figcaption class="muted small">{text}.</figcaption>
        </figure>
      ))}
    </div>
  );
}
