import { afterAll, beforeAll, expect, test } from "vitest";
import type { Page } from "playwright-core";
import { Studio } from "./studio";

let studio: Studio;
let page: Page;

beforeAll(async () => {
  studio = await Studio.start();
});
afterAll(() => studio.stop());

/// The demo's turntable steps are 36 degrees; the ring goes by 30.
const kViews = ["y000", "y036", "y072", "y108"];

async function turn_to(object: string, view: string): Promise<void> {
  await studio.show(`train/${object}/${view}.jpg`);
}

test("an object is taught in under a minute and recognised in the very next frame", async () => {
  const begin = performance.now();
  await turn_to("tea-mint", "background");
  page = await studio.open("#/live");
  await page.getByText("Nothing taught yet").waitFor();
  await studio.shoot(page, "live-empty");
  await page.getByRole("link", { name: "New object" }).click();
  await page.getByRole("heading", { name: "1. Clear the table" }).waitFor();
  await page.getByRole("button", { name: "The table is empty" }).click();

  const verdict = page.locator(".verdict");
  await expect.poll(() => verdict.getAttribute("class"), { timeout: 20_000 }).toContain("bad");
  await studio.shoot(page, "teach-nothing-there");
  expect(await page.getByRole("button", { name: "Take this view" }).isDisabled()).toBe(true);

  for (const view of kViews) {
    await turn_to("tea-mint", view);
    await expect.poll(() => verdict.getAttribute("class"), { timeout: 20_000 }).toMatch(/good|warn/);
    if (view === "y072") await studio.shoot(page, "teach");
    await page.getByRole("button", { name: "Take this view" }).click();
    await page.getByText(`${kViews.indexOf(view) + 1} view`).first().waitFor();
  }
  expect(await page.locator(".side.done").count()).toBe(kViews.length);
  await page.getByLabel("Name").fill("tea-mint");
  await studio.shoot(page, "teach-name");
  await page.getByRole("button", { name: "Save" }).click();

  await page.getByText("“tea-mint” is known").waitFor();
  await studio.show("test/breakfast.jpg");
  await page.locator(".detection", { hasText: "tea-mint" }).waitFor();
  expect(performance.now() - begin).toBeLessThan(60_000);
  await page.locator(".found-name", { hasText: "tea-mint" }).waitFor();
  await studio.shoot(page, "live");
});

test("the outline lies on the object", async () => {
  const label = page.locator(".found-name", { hasText: "tea-mint" });
  const stage = (await page.locator(".stage-picture").boundingBox())!;
  const at = (await label.boundingBox())!;
  const points = await page.locator(".found .edge").first().getAttribute("points");
  const xs = points!.split(" ").map((point) => Number(point.split(",")[0]));
  expect(Math.min(...xs)).toBeGreaterThan(420);
  expect(Math.max(...xs)).toBeLessThan(640);
  expect((at.x - stage.x) / stage.width).toBeGreaterThan(0.6);
});

test("a side that is known already is said to add little", async () => {
  await page.goto(`${studio.address}/#/teach`);
  await turn_to("mug", "background");
  await page.getByRole("button", { name: "The table is empty" }).click();
  await turn_to("mug", "y000");
  await page.locator(".verdict.good").waitFor();
  await page.getByRole("button", { name: "Take this view" }).click();
  await page.locator(".verdict.warn").waitFor();
  expect(await page.locator(".verdict").textContent()).toContain("known already");
});

test("views that were taken outlive a reload, and can be taken out", async () => {
  await page.reload();
  await page.getByRole("button", { name: "Go on with it" }).click();
  await page.getByRole("button", { name: "Take out view 0°" }).click();
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
  await page.getByRole("button", { name: "Use this mask" }).click();
  await page.getByText("1 view taken").waitFor();
});

test("a name that is there already takes the views only when that is said", async () => {
  await page.getByLabel("Name").fill("tea-mint");
  await page.getByRole("button", { name: "Save" }).click();
  await page.getByText("There is an object “tea-mint” already").waitFor();
  await page.getByLabel("Name").fill("mug");
  await page.getByRole("button", { name: "Save" }).click();
  await page.getByText("“mug” is known").waitFor();
});
