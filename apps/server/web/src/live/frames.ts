// The server's Motion JPEG, drawn on a canvas, so that it is known which frame is on the screen.
import { send } from "../api/client";
import { MultipartParser, type Part } from "./multipart";

const kRetryMs = 1000;

/// Draws every frame until `signal` aborts; goes on by itself after an interruption.
export async function show_frames(
  canvas: HTMLCanvasElement,
  on_frame: (frame: number) => void,
  signal: AbortSignal,
): Promise<void> {
  while (!signal.aborted) {
    try {
      const response = await send("/api/stream.mjpg", { signal });
      await draw_stream(response.body!.getReader(), canvas, on_frame);
    } catch {
      // Said by the live state; here it is only tried again.
    }
    await new Promise((done) => setTimeout(done, kRetryMs));
  }
}

async function draw_stream(
  reader: ReadableStreamDefaultReader<Uint8Array>,
  canvas: HTMLCanvasElement,
  on_frame: (frame: number) => void,
): Promise<void> {
  const parser = new MultipartParser();
  for (;;) {
    const { done, value } = await reader.read();
    if (done) return;
    const newest = parser.push(value).at(-1);
    if (newest) on_frame(await draw(newest, canvas));
  }
}

async function draw(part: Part, canvas: HTMLCanvasElement): Promise<number> {
  const picture = await createImageBitmap(new Blob([part.body], { type: "image/jpeg" }));
  if (canvas.width !== picture.width || canvas.height !== picture.height) {
    canvas.width = picture.width;
    canvas.height = picture.height;
  }
  canvas.getContext("2d")!.drawImage(picture, 0, 0);
  picture.close();
  return Number(part.headers.get("x-frame") ?? -1);
}
