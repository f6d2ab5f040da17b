// Is the newest result about what is on the screen?
import { useMemo, useReducer } from "preact/hooks";
import { connected, live, result } from "../api/events";
import type { OnFrame } from "./frames";
import { SceneMemory } from "./scene_memory";

interface Current {
  running: boolean; // pictures come
  looking: boolean; // and are searched
  current: boolean; // and the result is about what is shown
  on_frame: OnFrame;
}

export function use_current(): Current {
  const [, draw_again] = useReducer((count: number) => count + 1, 0);
  const memory = useMemo(() => ({ scenes: new SceneMemory(), drawn: true }), []);
  const is_current = (): boolean => memory.scenes.still_shows(result.value?.frame ?? -1);
  const on_frame: OnFrame = (frame, thumbnail) => {
    memory.scenes.remember(frame, thumbnail);
    if (is_current() !== memory.drawn) draw_again(0);
  };
  memory.drawn = is_current();
  const running = connected.value && live.value?.state === "running";
  const looking = running && live.value!.recognizing;
  return { running, looking, current: looking && memory.drawn, on_frame };
}
