import { afterAll, beforeAll, expect, test } from "vitest";
import type { Page } from "playwright-core";
import { check_for_everybody } from "./axe";
import { picture, Studio } from "./studio";

let studio: Studio;
let page: Page;

beforeAll(async () => {
  studio = await Studio.start();
});
afterAll(() => studio.stop());

/// The demo's turntable steps are 36 degrees; the ring goes by 30.
const kViews = ["y000", "y036", "y072", "y108"];

/// Shows the view to the camera, and waits until the page has looked at it.
async function turn_to(object: string, view: string): Promise<void> {
  await studio.show(`train/${object}/${view}.jpg`);
  const looked = (): Promise<unknown> => page.waitForResponse((response) => response.url().endsWith("/proposal"));
  await looked();
  await looked();
}

function box_of(image: string, name: string): [number, number, number, number] {
  const { tests } = JSON.parse(new TextDecoder().decode(picture("dataset.json"))) as Dataset;
  return tests.find((test) => test.image === image)!.objects.find((object) => object.name === name)!.box;
}

interface Dataset {
  tests: { image: string; objects: { name: string; box: [number, number, number, number] }[] }[];
}

/// What a person needs beside the machine: the test clicks at once, and its object turns by itself.
const kClickS = 1.5;
const kTurnS = 4;

test("an object is taught in under a minute and recognised in the very next frame", async () => {
  await studio.show("train/tea-mint/background.jpg");
  page = await studio.open("#/live", { bypassCSP: true });
  const begin = performance.now();
  const used_before_s = studio.server_seconds();
  await page.evaluate(count_clicks);
  await page.getByText("Nothing taught yet").waitFor();
  await studio.shoot(page, "live-empty");
  await page.getByRole("link", { name: "New object" }).click();
  await page.getByRole("heading", { name: "1. Clear the table" }).waitFor();
  const clock = page.getByRole("timer", { name: "Time taken" });
  await expect.poll(() => clock.textContent()).toMatch(/0:0[1-9]/); // it runs from "New object" on
  await page.getByRole("button", { name: "The table is empty" }).click();

  const verdict = page.locator(".verdict");
  await expect.poll(() => verdict.getAttribute("class")).toContain("bad");
  await studio.shoot(page, "teach-nothing-there");
  expect(await page.getByRole("button", { name: "Take this view" }).isDisabled()).toBe(true);

  for (const view of kViews) {
    await turn_to("tea-mint", view);
    await expect.poll(() => verdict.getAttribute("class")).toMatch(/good|warn/);
    if (view === "y072") await studio.shoot(page, "teach");
    await page.getByRole("button", { name: "Take this view" }).click();
    await page.getByText(`${kViews.indexOf(view) + 1} view`).first().waitFor();
  }
  expect(await page.locator(".side.done").count()).toBe(kViews.length);
  await page.getByLabel("Name").fill("tea-mint");
  await studio.shoot(page, "teach-name");
  await page.getByRole("button", { name: "Save" }).click();

  const said = await page.locator(".toast", { hasText: "“tea-mint” is known" }).textContent();
  const [, said_s] = /4 views in (\d+) s/.exec(said!)!;
  expect(Number(said_s)).toBeGreaterThan(0);
  expect(Number(said_s)).toBeLessThanOrEqual(Math.ceil((performance.now() - begin) / 1000));
  await studio.show("test/breakfast.jpg");
  await page.locator(".detection", { hasText: "tea-mint" }).waitFor();
  const taken_s = (performance.now() - begin) / 1000;
  const used_s = studio.server_seconds() - used_before_s;
  const clicks = await page.evaluate(() => (globalThis as Counting).clicks);
  expect(clicks).toBe(kViews.length + 3); // "New object", "The table is empty", the views, "Save"
  const slowness = studio.server_slowness();
  const alone_s = taken_s / slowness; // what others did on this machine meanwhile is not teaching
  const person_s = clicks! * kClickS + kViews.length * kTurnS;
  console.info(
    `Taught and recognised in ${taken_s.toFixed(1)} s with ${clicks} clicks; the server computed for ${used_s.toFixed(1)} s. ` +
      `The machine was slowed down ${slowness.toFixed(1)} times by others: ${alone_s.toFixed(1)} s, ` +
      `and ${person_s.toFixed(1)} s for a person's hands.`,
  );
  expect(alone_s + person_s).toBeLessThan(60);
  await page.locator(".found-name", { hasText: "tea-mint" }).waitFor();
  await studio.shoot(page, "live");
});

type Counting = typeof globalThis & { clicks?: number };

function count_clicks(): void {
  const page = globalThis as Counting;
  page.clicks = 0;
  addEventListener("click", (event) => (page.clicks! += event.isTrusted ? 1 : 0), true);
}

test("the outline lies on the object", async () => {
  const [x, y, width, height] = box_of("test/breakfast.jpg", "tea-mint");
  const farthest_side = async (): Promise<number> => {
    const outline = (await page.locator(".found .edge").first().getAttribute("points"))!;
    const points = outline.split(" ").map((point) => point.split(",").map(Number) as [number, number]);
    const [xs, ys] = [points.map((point) => point[0]), points.map((point) => point[1])];
    const sides = [Math.min(...xs) - x, Math.max(...xs) - x - width, Math.min(...ys) - y, Math.max(...ys) - y - height];
    return Math.max(...sides.map(Math.abs));
  };
  // Until the result of this picture comes, the outline is where the object stood on the turntable.
  await expect.poll(farthest_side).toBeLessThan(0.1 * Math.max(width, height));
});

test("a detection that is wrong is remembered, and that is taken back", async () => {
  await page.getByRole("button", { name: "tea-mint is wrong here" }).click();
  await page.getByText("Noted: that is not “tea-mint”").waitFor();
  await page.getByRole("button", { name: "Undo" }).click();
  await page.goto(`${studio.address}/#/settings`);
  await page.getByText("Nothing. A false detection can be marked").waitFor();
});

test("a side that is known already is said to add little", async () => {
  await page.goto(`${studio.address}/#/teach`);
  await studio.show("train/mug/background.jpg");
  await page.getByRole("button", { name: "The table is empty" }).click();
  await turn_to("mug", "y000");
  await page.locator(".verdict.good").waitFor();
  await page.getByRole("button", { name: "Take this view" }).click();
  await page.locator(".verdict.warn").waitFor();
  expect(await page.locator(".verdict").textContent()).toContain("known already");
  await check_for_everybody(page, "teaching");
  await page.getByRole("button", { name: "Take this view" }).click(); // nevertheless
  await page.locator(".taken-view", { hasText: "30°" }).getByText("adds little").waitFor();
  expect(await page.locator(".side.idle").getAttribute("aria-label")).toContain("adds little");
  await studio.shoot(page, "teach-adds-little");
  await check_for_everybody(page, "a view that adds little");
});

test("views that were taken outlive a reload, and are not thrown away by one click", async () => {
  await page.reload();
  await page.getByRole("button", { name: "Discard" }).click();
  await page.getByRole("dialog").getByText("2 views will be lost").waitFor();
  await check_for_everybody(page, "discard");
  await page.getByRole("button", { name: "Keep them" }).click();
  await page.getByRole("button", { name: "Go on with it" }).click();
  await page.getByRole("button", { name: "Start over" }).click();
  await page.getByRole("dialog").getByText("2 views taken so far will be lost").waitFor();
  await page.getByRole("button", { name: "Go on", exact: true }).click();
  expect(await page.locator(".taken-view").count()).toBe(2);
});

test("a view that was taken is taken out, and comes back", async () => {
  await page.getByRole("button", { name: "Take out view 0°" }).click();
  await expect.poll(() => page.locator(".taken-view").count()).toBe(1);
  expect(await page.locator(".taken-mark").count()).toBe(0); // what it repeated is gone
  await page.locator(".toast", { hasText: "View 0° is taken out" }).getByRole("button", { name: "Undo" }).click();
  await expect.poll(() => page.locator(".taken-view").count()).toBe(2);
  for (const side of ["0°", "30°"]) await page.getByRole("button", { name: `Take out view ${side}` }).click();
  await expect.poll(() => page.locator(".taken-view").count()).toBe(0);
});

test("a mask is corrected by keyboard and taken", async () => {
  await page.locator(".verdict.good").waitFor();
  await page.getByRole("button", { name: "Correct mask" }).click();
  const canvas = page.getByRole("application");
  await canvas.focus();
  for (let i = 0; i < 6; ++i) await canvas.press("ArrowUp");
  await canvas.press("Space");
  await studio.shoot(page, "mask");
  expect(await page.evaluate(veil_at_brush)).toBeGreaterThan(100);
  await check_for_everybody(page, "mask");
  await page.getByRole("button", { name: "Use this mask" }).click();
  await page.getByText("1 view taken").waitFor();
});

/// How dark the picture is made where the brush is, 0 to 255.
function veil_at_brush(): number {
  const canvas = document.querySelector<HTMLCanvasElement>(".mask-canvas")!;
  const brush = document.querySelector<HTMLElement>(".mask-brush")!;
  const [x, y] = [brush.style.left, brush.style.top].map((place) => parseFloat(place) / 100);
  return canvas.getContext("2d")!.getImageData(x! * canvas.width, y! * canvas.height, 1, 1).data[3]!;
}

test("a name that is there already takes the views only when that is said", async () => {
  await page.getByLabel("Name").fill("tea-mint");
  await page.getByRole("button", { name: "Save" }).click();
  await page.getByText("There is an object “tea-mint” already").waitFor();
  await page.getByLabel("Name").fill("mug");
  await page.getByRole("button", { name: "Save" }).click();
  await page.getByText("“mug” is known").waitFor();
});
