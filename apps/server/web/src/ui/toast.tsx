// Short messages at the bottom, read out by screen readers, some with a way back.
import { signal } from "@preact/signals";
import "./toast.css";

interface Toast {
  id: number;
  text: string;
  kind: "info" | "error";
  action?: { label: string; run: () => void };
}

const toasts = signal<Toast[]>([]);
const kShownMs = 6000;
const kActionMs = 30_000; // a way back is not to be missed
let last_id = 0;

function remove(id: number): void {
  toasts.value = toasts.value.filter((toast) => toast.id !== id);
}

export function say(text: string, action?: Toast["action"], kind: Toast["kind"] = "info"): void {
  const id = ++last_id;
  toasts.value = [...toasts.value.slice(-1), { id, text, kind, action }];
  setTimeout(() => remove(id), action ? kActionMs : kShownMs);
}

export function say_error(error: unknown): void {
  if (error instanceof DOMException && error.name === "AbortError") return;
  say(error instanceof Error ? error.message : String(error), undefined, "error");
}

/// Runs a step that may fail; the reason is shown. True when it went well.
export async function attempt(step: () => Promise<unknown>): Promise<boolean> {
  try {
    await step();
    return true;
  } catch (error) {
    say_error(error);
    return false;
  }
}

export function Toasts() {
  return (
    <div class="toasts" role="status" aria-live="polite">
      {toasts.value.map((toast) => (
        <div key={toast.id} class={`toast ${toast.kind}`}>
          <span>{toast.text}</span>
          {toast.action && (
            <button
              class="button plain"
              onClick={() => {
                toast.action!.run();
                remove(toast.id);
              }}
            >
              {toast.action.label}
            </button>
          )}
          <button class="button plain" aria-label="Dismiss" onClick={() => remove(toast.id)}>
            ✕
          </button>
        </div>
      ))}
    </div>
  );
}
