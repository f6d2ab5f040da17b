// The canvas behind the brush: strokes, steps back, and the way to and from a mask file.
import { alpha_from_grey, grey_from_alpha } from "./mask";

const kMaxSteps = 12;
const kVeil = "rgba(6, 12, 14, 0.68)";

export class Painting {
  private canvas = document.createElement("canvas");
  private context: CanvasRenderingContext2D;
  private steps: ImageData[] = [];

  constructor(
    private shown: HTMLCanvasElement,
    size: { width: number; height: number },
    mask: ImageBitmap | null,
  ) {
    this.canvas.width = shown.width = size.width;
    this.canvas.height = shown.height = size.height;
    this.context = this.canvas.getContext("2d", { willReadFrequently: true })!;
    if (mask) {
      this.context.drawImage(mask, 0, 0);
      const pixels = this.pixels();
      alpha_from_grey(pixels.data);
      this.context.putImageData(pixels, 0, 0);
    }
    this.show();
  }

  get can_go_back(): boolean {
    return this.steps.length > 0;
  }

  /// Remembers the present state: what follows until the next call is one step.
  begin_step(): void {
    this.steps = [...this.steps.slice(1 - kMaxSteps), this.pixels()];
  }

  stroke(from: [number, number], to: [number, number], size: number, add: boolean): void {
    const pen = this.context;
    pen.globalCompositeOperation = add ? "source-over" : "destination-out";
    pen.strokeStyle = pen.fillStyle = "#fff";
    pen.lineCap = pen.lineJoin = "round";
    pen.lineWidth = size;
    pen.beginPath();
    pen.moveTo(...from);
    pen.lineTo(...to);
    pen.stroke();
    pen.beginPath(); // a line of no length leaves nothing
    pen.arc(...to, size / 2, 0, 2 * Math.PI);
    pen.fill();
    this.show();
  }

  step_back(): void {
    const last = this.steps.pop();
    if (!last) return;
    this.context.putImageData(last, 0, 0);
    this.show();
  }

  async to_png(): Promise<Blob> {
    const pixels = this.pixels();
    grey_from_alpha(pixels.data);
    const canvas = document.createElement("canvas");
    canvas.width = pixels.width;
    canvas.height = pixels.height;
    canvas.getContext("2d")!.putImageData(pixels, 0, 0);
    return new Promise((done, failed) =>
      canvas.toBlob((blob) => (blob ? done(blob) : failed(new Error("The mask could not be written."))), "image/png"),
    );
  }

  private pixels(): ImageData {
    return this.context.getImageData(0, 0, this.canvas.width, this.canvas.height);
  }

  private show(): void {
    const pen = this.shown.getContext("2d")!;
    pen.globalCompositeOperation = "copy";
    pen.fillStyle = kVeil;
    pen.fillRect(0, 0, this.shown.width, this.shown.height);
    pen.globalCompositeOperation = "destination-out";
    pen.drawImage(this.canvas, 0, 0);
  }
}
