// "Why not?": a button, and the question that it opens. `picture` gives what is asked about.
import { useState } from "preact/hooks";
import { attempt } from "../ui/toast";
import { WhyDialog } from "./why_dialog";

export function WhyNot({ picture }: { picture: () => Promise<Blob> }) {
  const [asked, set_asked] = useState<Blob | null>(null);
  return (
    <>
      <button
        class="button"
        title="Says of each object why it is found in this picture, or why not"
        onClick={() => void attempt(async () => set_asked(await picture()))}
      >
        Why not?
      </button>
      {asked && <WhyDialog picture={asked} on_close={() => set_asked(null)} />}
    </>
  );
}
