// How long is the way from the camera to the eye? Prints numbers, and demands none: POSEVOTE_LATENCY
// says how many pictures are shown.
import { readdirSync } from "node:fs";
import { join } from "node:path";
import { expect, test } from "vitest";
import type { Page } from "playwright-core";
import { demo, picture, Studio } from "./studio";

const pictures = Number(process.env.POSEVOTE_LATENCY ?? 0);
const kScenes = ["test/reading.jpg", "test/breakfast.jpg"];

type Watching = typeof globalThis & { painted?: number[]; outlined?: number[] };

const now = (): number => performance.timeOrigin + performance.now();

test.skipIf(!pictures)("from a frame that is posted to its pixels and to its outlines", async () => {
  const studio = await Studio.start();
  for (const object of ["poster", "mug", "book", "tea-mint", "tea-cherry", "muesli", "soup", "juice"]) {
    const views = readdirSync(join(demo, "train", object)).map((file) => file.replace(".jpg", ""));
    await studio.teach(object, views.filter((view) => view !== "background").slice(0, 4));
  }
  const page = await studio.open("#/live");
  await studio.ask("POST", "live/frame", picture(kScenes[1]!));
  await page.locator(".found-name").first().waitFor();
  await page.evaluate(watch);
  const painted: number[] = [];
  const outlined: number[] = [];
  for (let i = 0; i < pictures; ++i) {
    const begin = now();
    await studio.ask("POST", "live/frame", picture(kScenes[i % 2]!));
    painted.push((await at(page, "painted", i)) - begin);
    outlined.push((await at(page, "outlined", i)) - begin);
  }
  console.info(`Until it is painted: ${summary(painted)}; until the outlines are: ${summary(outlined)}.`);
  expect(painted).toHaveLength(pictures);
  await studio.stop();
});

/// Notes when the canvas shows another picture, and when other names lie over it.
function watch(): void {
  const noted = globalThis as Watching;
  noted.painted = [];
  noted.outlined = [];
  const canvas = document.querySelector<HTMLCanvasElement>(".stage canvas")!;
  const colour = (): number[] => [...canvas.getContext("2d")!.getImageData(canvas.width / 2, canvas.height / 2, 1, 1).data];
  const names = (): string => [...document.querySelectorAll(".found-name")].map((name) => name.firstChild!.textContent).join();
  let [last_colour, last_names] = [colour(), names()];
  const look = (time: number): void => {
    const [shown, over] = [colour(), names()];
    if (shown.some((value, i) => Math.abs(value - last_colour[i]!) > 8)) {
      noted.painted!.push(performance.timeOrigin + time);
      last_colour = shown;
    }
    if (over && over !== last_names) {
      noted.outlined!.push(performance.timeOrigin + time);
      last_names = over;
    }
    requestAnimationFrame(look);
  };
  requestAnimationFrame(look);
}

async function at(page: Page, what: "painted" | "outlined", i: number): Promise<number> {
  const handle = await page.waitForFunction(([list, nth]) => (globalThis as Watching)[list]![nth], [what, i] as const);
  return (await handle.jsonValue()) as number;
}

function summary(delays_ms: number[]): string {
  const sorted = [...delays_ms].sort((a, b) => a - b);
  const share = (part: number): string => sorted[Math.floor(part * (sorted.length - 1))]!.toFixed(0);
  return `median ${share(0.5)} ms, 95 % ${share(0.95)} ms`;
}
