// What can be taken back says so, and offers it.
import { undo } from "../api/calls";
import type { Undo } from "../api/types";
import { attempt, say } from "../ui/toast";

export async function do_with_undo(step: Promise<Undo>, done: string, on_undone?: () => void): Promise<void> {
  const { undo: id } = await step;
  say(done, {
    label: "Undo",
    run: () =>
      void attempt(async () => {
        await undo(id);
        on_undone?.();
      }),
  });
}
