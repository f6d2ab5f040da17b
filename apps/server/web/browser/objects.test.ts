import { afterAll, beforeAll, expect, test } from "vitest";
import type { Page } from "playwright-core";
import { check_for_everybody } from "./axe";
import { Studio } from "./studio";

let studio: Studio;
let page: Page;

beforeAll(async () => {
  studio = await Studio.start();
  await studio.teach("mug", ["y000", "y030", "y060"]);
  await studio.teach("soup", ["y000"]);
  await studio.teach("poster", ["cover"]);
  page = await studio.open("#/objects", { bypassCSP: true });
});
afterAll(() => studio.stop());

/// What was said to be done is taken back.
const undo = (said: string): Promise<void> =>
  page.locator(".toast", { hasText: said }).getByRole("button", { name: "Undo" }).click();

async function names(): Promise<string[]> {
  const { objects } = await studio.ask<{ objects: { object: string }[] }>("GET", "objects");
  return objects.map(({ object }) => object);
}

test("all objects are listed with their pictures", async () => {
  await page.locator("a.object").nth(2).waitFor();
  expect(await page.locator("a.object b").allTextContents()).toEqual(["mug", "poster", "soup"]);
  await page.waitForFunction(() => [...document.images].every((image) => image.complete));
  await studio.shoot(page, "objects");
});

test("an object is renamed; a name that is taken is refused in the dialog", async () => {
  await page.getByRole("link", { name: /soup/ }).click();
  await page.getByRole("button", { name: "Rename" }).click();
  await page.getByLabel("New name").fill("mug");
  await page.getByRole("dialog").getByRole("button", { name: "Rename" }).click();
  await page.getByRole("alert").filter({ hasText: "mug" }).waitFor();
  await check_for_everybody(page, "rename");
  await rename_to("tomato soup / 400 ml");
  await undo("is now called");
  await page.getByRole("heading", { name: "soup", exact: true }).waitFor();
  await page.getByRole("button", { name: "Rename" }).click();
  await rename_to("tomato soup / 400 ml");
  expect(await names()).toEqual(["mug", "poster", "tomato soup / 400 ml"]);
});

async function rename_to(name: string): Promise<void> {
  await page.getByLabel("New name").fill(name);
  await page.getByRole("dialog").getByRole("button", { name: "Rename" }).click();
  await page.getByRole("heading", { name }).waitFor();
}

test("an object is deleted and comes back", async () => {
  await page.getByRole("button", { name: "Delete" }).click();
  await page.getByText("is deleted").waitFor();
  expect(await names()).toEqual(["mug", "poster"]);
  await undo("” is deleted");
  await page.getByRole("heading", { name: "tomato soup / 400 ml" }).waitFor();
  expect(await names()).toHaveLength(3);
});

test("what was deleted is found again when its message is gone", async () => {
  await page.getByRole("button", { name: "Delete" }).click();
  await page.getByText("is deleted").first().waitFor();
  await page.reload();
  await page.getByText("Recently deleted (1)").click();
  await page.getByText("“tomato soup / 400 ml” just now").waitFor();
  await studio.shoot(page, "recently-deleted");
  await check_for_everybody(page, "recently deleted");
  await page.getByRole("button", { name: "Bring back: “tomato soup / 400 ml”" }).click();
  await expect.poll(() => page.locator("a.object").count()).toBe(3);
  await expect.poll(() => page.getByText("Recently deleted").count()).toBe(0);
});

test("a view has a quality card, and can be deleted with a way back", async () => {
  await page.goto(`${studio.address}/#/objects/mug`);
  await page.locator(".view", { hasText: "30°" }).click();
  await expect.poll(() => page.locator(".quality dd").first().textContent()).toMatch(/^\d+$/);
  await studio.shoot(page, "view");
  await check_for_everybody(page, "view");
  await page.getByRole("button", { name: "Delete view" }).click();
  await expect.poll(() => page.locator(".view").count()).toBe(2);
  await undo("The view is deleted");
  await expect.poll(() => page.locator(".view").count()).toBe(3);
});

test("a taught mask is corrected", async () => {
  const before = await masks();
  await page.locator(".view", { hasText: "30°" }).click();
  await page.getByRole("button", { name: "Correct the mask" }).click();
  const canvas = (await page.locator(".mask-canvas").boundingBox())!;
  await page.getByLabel("Add to the object").check();
  await page.mouse.move(canvas.x + 0.5 * canvas.width, canvas.y + 0.4 * canvas.height);
  await page.mouse.down();
  await page.mouse.move(canvas.x + 0.5 * canvas.width, canvas.y + 0.2 * canvas.height, { steps: 3 });
  await page.mouse.up();
  await page.getByRole("button", { name: "Use this mask" }).click();
  await page.getByRole("dialog").waitFor({ state: "detached" });
  await expect.poll(masks).not.toEqual(before);
});

async function masks(): Promise<number[]> {
  const { views } = await studio.ask<{ views: { coverage: number }[] }>("GET", "objects/mug");
  return views.map(({ coverage }) => coverage).sort();
}

test("an object that gets further views shows the sides that it has", async () => {
  await page.getByRole("link", { name: "Add views" }).click();
  await page.getByRole("heading", { name: "More views of “mug”" }).waitFor();
  await studio.show("train/mug/background.jpg");
  await page.getByRole("button", { name: "The table is empty" }).click();
  await expect.poll(() => page.locator(".side.done").count()).toBe(3);
  expect(await page.locator(".side.next").getAttribute("aria-label")).toBe("90°, missing");
  await studio.show("train/mug/y030.jpg");
  await page.locator(".verdict.warn", { hasText: "known already" }).waitFor();
});

test("two objects become one, and two again", async () => {
  await page.goto(`${studio.address}/#/objects/poster`);
  await page.getByRole("button", { name: "Merge" }).click();
  await page.getByLabel("Into").selectOption("mug");
  await check_for_everybody(page, "merge");
  await page.getByRole("dialog").getByRole("button", { name: "Merge" }).click();
  await page.getByRole("heading", { name: "mug" }).waitFor();
  await expect.poll(() => page.locator(".view").count()).toBe(4);
  await undo("is now part of");
  await page.getByRole("heading", { name: "poster" }).waitFor();
  expect(await names()).toHaveLength(3);
});

test("what was exported is imported again", async () => {
  await page.goto(`${studio.address}/#/objects`);
  const [download] = await Promise.all([
    page.waitForEvent("download"),
    page.getByRole("link", { name: "Export all" }).click(),
  ]);
  const file = await download.path();
  await studio.ask("DELETE", "objects/mug");
  await expect.poll(() => page.locator("a.object").count()).toBe(2);
  await page.locator("#import-file").setInputFiles(file);
  await check_for_everybody(page, "import");
  const go = page.getByRole("dialog").getByRole("button", { name: "Import" });
  await page.getByLabel("Replace the object that is there").check();
  expect(await go.isDisabled()).toBe(true);
  await page.getByLabel("this cannot be undone").check();
  expect(await go.isDisabled()).toBe(false);
  await page.getByLabel("Add the views").check();
  await page.getByRole("dialog").getByRole("button", { name: "Import" }).click();
  await page.getByText(/Imported 3 objects/).waitFor();
  await expect.poll(() => page.locator("a.object").count()).toBe(3);
});

test("an object that is not there is a designed page", async () => {
  await page.goto(`${studio.address}/#/objects/nothing`);
  await page.getByRole("heading", { name: "There is no “nothing”" }).waitFor();
});
