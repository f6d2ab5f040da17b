// Results come later than frames. If the camera meanwhile sees something else altogether - another
// picture of a folder, a camera that was turned - their outlines must not be drawn over that.

const kRemembered = 90; // frames; 3 s at the rate of most cameras
const kOtherScene = 14; // mean difference of the thumbnails, grey levels: above hands, noise, exposure

export class SceneMemory {
  private thumbnails = new Map<number, Uint8Array>();
  private newest = -1;

  /// `thumbnail`: grey levels, always of one size.
  remember(frame: number, thumbnail: Uint8Array): void {
    this.thumbnails.set(frame, thumbnail);
    this.newest = frame;
    const [oldest] = this.thumbnails.keys();
    if (this.thumbnails.size > kRemembered) this.thumbnails.delete(oldest!);
  }

  /// Does the newest frame still show what `frame` showed? Yes, as long as that is not known.
  still_shows(frame: number): boolean {
    const then = this.thumbnails.get(frame);
    const now = this.thumbnails.get(this.newest);
    return !then || !now || difference(then, now) <= kOtherScene;
  }
}

function difference(a: Uint8Array, b: Uint8Array): number {
  let sum = 0;
  for (let i = 0; i < a.length; ++i) sum += Math.abs(a[i]! - b[i]!);
  return sum / a.length;
}
