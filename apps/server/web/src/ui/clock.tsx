// Counts up from `since` (milliseconds of performance.now()).
import { useEffect, useState } from "preact/hooks";
import { clock } from "./numbers";

export function Clock({ since }: { since: number }) {
  const [now, set_now] = useState(() => performance.now());
  useEffect(() => {
    const timer = setInterval(() => set_now(performance.now()), 250);
    return () => clearInterval(timer);
  }, [since]);
  return (
    <span class="tag" role="timer" aria-label="Time taken">
      {clock(now - since)}
    </span>
  );
}
