// The camera's picture with what lies over it, and a sentence when there is none.
import type { ComponentChildren } from "preact";
import { useEffect, useRef } from "preact/hooks";
import { connected, live } from "../api/events";
import { sentence } from "../ui/numbers";
import { Stage } from "../ui/stage";
import { while_shown } from "../ui/while_shown";
import { show_frames, type OnFrame } from "./frames";

interface Props {
  label: string;
  on_frame?: OnFrame;
  children?: ComponentChildren;
}

const kUsualSize = { width: 640, height: 480 };

export function live_size(): { width: number; height: number } {
  return live.value?.width ? live.value : kUsualSize;
}

export function LivePicture({ label, on_frame = () => undefined, children }: Props) {
  const canvas = useRef<HTMLCanvasElement>(null);
  const { width, height } = live_size();
  useEffect(
    () =>
      while_shown(() => {
        const controller = new AbortController();
        void show_frames(canvas.current!, on_frame, controller.signal);
        return () => controller.abort();
      }),
    [],
  );
  return (
    <Stage width={width} height={height} label={label}>
      <canvas ref={canvas} />
      {children}
      <Interruption />
    </Stage>
  );
}

function Interruption() {
  const state = live.value;
  if (connected.value && state?.state === "running") return null;
  const [title, text] = !connected.value
    ? ["The server does not answer", "The page goes on by itself as soon as it is back."]
    : state?.state === "lost"
      ? ["Camera lost", state.message ? sentence(state.message) : "It is tried again all the time."]
      : ["Waiting for the first picture", state?.message ? sentence(state.message) : ""];
  return (
    <div class="stage-message" role="status">
      <h2>{title}</h2>
      <p>{text}</p>
    </div>
  );
}
