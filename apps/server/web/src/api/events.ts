// The server's events as signals that every page can read.
import { signal } from "@preact/signals";
import { get_access } from "./calls";
import { access } from "./client";
import type { Live, Recognition } from "./types";

export const live = signal<Live | null>(null);
export const result = signal<Recognition | null>(null);
export const objects_version = signal(0);
export const connected = signal(true);

const kRetryMs = 1500;

/// By name, and copies from left to right: ordered by how sure they are, they would change places all the time.
export function in_order(recognition: Recognition): Recognition {
  const detections = [...recognition.detections].sort(
    (a, b) => a.object.localeCompare(b.object) || a.box[0] - b.box[0],
  );
  return { ...recognition, detections };
}

/// Listens until the returned function is called; begins again by itself when the server goes away.
export function listen(): () => void {
  let events: EventSource | null = null;
  let timer = 0;
  const open = (): void => {
    events = new EventSource("/api/events");
    events.onopen = () => (connected.value = true);
    events.addEventListener("live", (event) => (live.value = JSON.parse(event.data)));
    events.addEventListener("result", (event) => (result.value = in_order(JSON.parse(event.data))));
    events.addEventListener("objects", (event) => (objects_version.value = JSON.parse(event.data).version));
    events.onerror = () => {
      connected.value = false;
      events!.close();
      // Gone, or no longer let in? Only the server can tell.
      get_access().then(
        (answer) => (access.value = answer),
        () => undefined,
      );
      timer = setTimeout(open, kRetryMs) as unknown as number;
    };
  };
  open();
  return () => {
    clearTimeout(timer);
    events?.close();
  };
}
