// The server's Motion JPEG, drawn on a canvas, so that it is known which frame is on the screen.
import { send } from "../api/client";
import { MultipartParser, type Part } from "./multipart";

const kRetryMs = 1000;
const kThumbnail = { width: 16, height: 12 };

export type OnFrame = (frame: number, thumbnail: Uint8Array) => void;

/// Draws every frame until `signal` aborts; goes on by itself after an interruption.
export async function show_frames(canvas: HTMLCanvasElement, on_frame: OnFrame, signal: AbortSignal): Promise<void> {
  const small = document.createElement("canvas");
  Object.assign(small, kThumbnail);
  const pen = small.getContext("2d", { willReadFrequently: true })!;
  const show = async (part: Part): Promise<void> => {
    await draw(part, canvas);
    pen.drawImage(canvas, 0, 0, small.width, small.height);
    on_frame(Number(part.headers.get("x-frame") ?? -1), grey_of(pen.getImageData(0, 0, small.width, small.height).data));
  };
  while (!signal.aborted) {
    try {
      const response = await send("/api/stream.mjpg", { signal });
      await read_stream(response.body!.getReader(), show);
    } catch {
      // Said by the live state; here it is only tried again.
    }
    await new Promise((done) => setTimeout(done, kRetryMs));
  }
}

async function read_stream(
  reader: ReadableStreamDefaultReader<Uint8Array>,
  show: (part: Part) => Promise<void>,
): Promise<void> {
  const parser = new MultipartParser();
  for (;;) {
    const { done, value } = await reader.read();
    if (done) return;
    const newest = parser.push(value).at(-1);
    if (newest) await show(newest);
  }
}

async function draw(part: Part, canvas: HTMLCanvasElement): Promise<void> {
  const picture = await createImageBitmap(new Blob([part.body], { type: "image/jpeg" }));
  if (canvas.width !== picture.width || canvas.height !== picture.height) {
    canvas.width = picture.width;
    canvas.height = picture.height;
  }
  canvas.getContext("2d")!.drawImage(picture, 0, 0);
  picture.close();
}

function grey_of(rgba: Uint8ClampedArray): Uint8Array {
  return Uint8Array.from({ length: rgba.length / 4 }, (_, i) => (rgba[4 * i]! + 2 * rgba[4 * i + 1]! + rgba[4 * i + 2]!) / 4);
}
