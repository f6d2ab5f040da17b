// Data of the server in a component: loaded anew whenever a key changes.
import { useEffect, useState } from "preact/hooks";

export interface Loaded<T> {
  data?: T;
  error?: Error;
  reload: () => void;
}

export function use_loaded<T>(load: (signal: AbortSignal) => Promise<T>, keys: unknown[]): Loaded<T> {
  const [state, set_state] = useState<{ data?: T; error?: Error }>({});
  const [round, set_round] = useState(0);
  useEffect(() => {
    const controller = new AbortController();
    load(controller.signal).then(
      (data) => !controller.signal.aborted && set_state({ data }),
      (error: Error) => !controller.signal.aborted && set_state((old) => ({ ...old, error })),
    );
    return () => controller.abort();
  }, [...keys, round]);
  return { ...state, reload: () => set_round((value) => value + 1) };
}
