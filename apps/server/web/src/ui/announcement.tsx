// What a screen reader says when it has changed, and stayed so for a moment; nobody sees it.
import { useEffect, useState } from "preact/hooks";

const kSteadyMs = 1000;

export function Announcement({ text }: { text: string }) {
  const [said, set_said] = useState("");
  useEffect(() => {
    const timer = setTimeout(() => set_said(text), kSteadyMs);
    return () => clearTimeout(timer);
  }, [text]);
  return (
    <p class="hidden-text" role="status">
      {said}
    </p>
  );
}
