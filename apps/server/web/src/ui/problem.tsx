// Why a step failed, said where it was asked for: in a dialog the messages at the bottom are out of reach.
import { useState } from "preact/hooks";

export function use_problem() {
  const [text, set_text] = useState("");
  const [busy, set_busy] = useState(false);
  return {
    busy,
    shown: (
      <p class="note bad small" role="alert" hidden={!text}>
        {text}
      </p>
    ),
    forget: () => set_text(""),
    async run(step: () => Promise<void>): Promise<void> {
      set_busy(true);
      set_text("");
      try {
        await step();
      } catch (error) {
        set_text((error as Error).message);
      }
      set_busy(false);
    },
  };
}
