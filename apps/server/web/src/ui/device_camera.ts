// This device's own camera: a phone is both screen and eye. Frames are grabbed as JPEG.
import type { RefObject } from "preact";
import { useEffect, useRef, useState } from "preact/hooks";

const kWidth = 1280;

export interface DeviceCamera {
  video: RefObject<HTMLVideoElement | null>;
  size: { width: number; height: number };
  problem: string; // empty while it runs
  ready: boolean;
  grab: () => Promise<Blob>;
}

export function use_device_camera(): DeviceCamera {
  const video = useRef<HTMLVideoElement>(null);
  const [size, set_size] = useState({ width: 640, height: 480 });
  const [problem, set_problem] = useState("");
  const [ready, set_ready] = useState(false);
  useEffect(() => {
    let stream: MediaStream | undefined;
    let gone = false;
    open_camera().then(
      async (opened) => {
        stream = opened;
        if (gone) return stop(stream);
        const shown = video.current!;
        shown.srcObject = stream;
        await shown.play();
        set_size({ width: shown.videoWidth, height: shown.videoHeight });
        set_ready(true);
      },
      (error: Error) => set_problem(reason_of(error)),
    );
    return () => {
      gone = true;
      if (stream) stop(stream);
    };
  }, []);
  return { video, size, problem, ready, grab: () => grab(video.current!) };
}

function open_camera(): Promise<MediaStream> {
  if (!navigator.mediaDevices)
    return Promise.reject(
      new Error("Browsers allow the camera only on https pages and on this machine itself (localhost)."),
    );
  return navigator.mediaDevices.getUserMedia({ video: { facingMode: "environment", width: { ideal: kWidth } } });
}

function stop(stream: MediaStream): void {
  for (const track of stream.getTracks()) track.stop();
}

function reason_of(error: Error): string {
  if (error.name === "NotAllowedError") return "The browser was not allowed to use the camera. Allow it in its settings.";
  if (error.name === "NotFoundError") return "This device has no camera.";
  return error.message;
}

async function grab(video: HTMLVideoElement): Promise<Blob> {
  const canvas = document.createElement("canvas");
  canvas.width = video.videoWidth;
  canvas.height = video.videoHeight;
  canvas.getContext("2d")!.drawImage(video, 0, 0);
  return new Promise((done, failed) =>
    canvas.toBlob((blob) => (blob ? done(blob) : failed(new Error("The camera gives no picture."))), "image/jpeg", 0.92),
  );
}
