import { join } from "node:path";
import { afterAll, beforeAll, expect, test } from "vitest";
import type { Page } from "playwright-core";
import { check_for_everybody } from "./axe";
import { demo, picture, Studio } from "./studio";

let studio: Studio;
let page: Page;

beforeAll(async () => {
  studio = await Studio.start();
  page = await studio.open("#/teach", { bypassCSP: true });
  await page.getByText("Pictures", { exact: true }).click();
});
afterAll(() => studio.stop());

const choose = (...names: string[]): Promise<void> =>
  page.locator("input[type=file]").first().setInputFiles(names.map((name) => join(demo, name)));

async function impostors(): Promise<number> {
  return (await studio.ask<{ impostors: unknown[] }>("GET", "impostors")).impostors.length;
}

async function save(name: string): Promise<void> {
  await page.getByLabel("Name").fill(name);
  await page.getByRole("button", { name: "Save" }).click();
  await page.getByText(`“${name}” is known`).waitFor();
}

test("a cover is taught whole", async () => {
  await choose("train/poster/cover.jpg");
  await page.locator(".verdict.good").waitFor();
  await studio.shoot(page, "pictures-cover");
  await page.getByRole("button", { name: "Take this view" }).click();
  await page.getByText("1 view taken").waitFor();
  await save("poster");
});

test("what differs from the empty table is taught, the side told by the file's name", async () => {
  await page.goto(`${studio.address}/#/teach`);
  await page.getByText("Pictures", { exact: true }).click();
  await choose("train/mug/background.jpg", "train/mug/y000.jpg", "train/mug/y030.jpg");
  for (const side of ["0", "30"]) {
    await expect.poll(() => page.getByLabel("Side, in degrees").inputValue()).toBe(side);
    await page.locator(".verdict.good, .verdict.warn").waitFor();
    await page.locator(".silhouette").waitFor();
    await page.getByRole("button", { name: "Take this view" }).click();
  }
  await page.getByText("2 views taken").waitFor();
  await save("mug");
});

test("a box drawn by hand is taught", async () => {
  await page.goto(`${studio.address}/#/teach`);
  await page.getByText("Pictures", { exact: true }).click();
  await choose("train/book/y000.jpg");
  await page.getByLabel("In a box that I draw").check();
  const area = (await page.locator(".box-area").boundingBox())!;
  await page.mouse.move(area.x + 0.4 * area.width, area.y + 0.2 * area.height);
  await page.mouse.down();
  await page.mouse.move(area.x + 0.62 * area.width, area.y + 0.8 * area.height, { steps: 4 });
  await page.mouse.up();
  await page.locator(".verdict.good").waitFor();
  await studio.shoot(page, "pictures-box");
  await check_for_everybody(page, "box");
  await page.getByRole("button", { name: "Take this view" }).click();
  await page.getByText("1 view taken").waitFor();
  await save("book");
});

test("pictures are tried: what is found, what the steps left, and what is wrong", async () => {
  await page.goto(`${studio.address}/#/try`);
  await choose("test/reading.jpg");
  await page.locator(".detection").first().waitFor();
  expect(await page.locator(".steps tbody tr").count()).toBe(4);
  await studio.shoot(page, "try");
  const before = await impostors();
  await page.getByRole("button", { name: /is wrong here/ }).first().click();
  await page.getByText(/Noted: that is not/).waitFor();
  expect(await impostors()).toBe(before + 1);
  await page.getByRole("button", { name: "Undo" }).click();
  await expect.poll(impostors).toBe(before);
});

async function drop(...names: string[]): Promise<void> {
  const files = names.map((name) => ({ name, base64: Buffer.from(picture(name)).toString("base64") }));
  const dataTransfer = await page.evaluateHandle((dropped) => {
    const transfer = new DataTransfer();
    for (const { name, base64 } of dropped) {
      const bytes = Uint8Array.from(atob(base64), (letter) => letter.charCodeAt(0));
      transfer.items.add(new File([bytes], name.split("/").at(-1)!, { type: "image/jpeg" }));
    }
    return transfer;
  }, files);
  await page.dispatchEvent(".drop-zone", "dragover", { dataTransfer });
  await page.locator(".drop-zone.over").waitFor();
  await page.dispatchEvent(".drop-zone", "drop", { dataTransfer });
}

test("pictures are dropped on the page to be taught", async () => {
  await page.goto(`${studio.address}/#/teach`);
  await page.getByText("Pictures", { exact: true }).click();
  await drop("train/juice/y000.jpg", "train/juice/background.jpg");
  await page.locator(".silhouette").waitFor();
  await page.locator(".verdict.good, .verdict.warn").waitFor();
  await page.getByRole("button", { name: "Take this view" }).click();
  await page.getByText("1 view taken").waitFor();
  await save("juice");
});

test("a picture is dropped on the page to be tried", async () => {
  await page.goto(`${studio.address}/#/try`);
  await drop("train/poster/cover.jpg");
  await page.locator(".detection", { hasText: "poster" }).waitFor();
  expect(await page.locator(".drop-zone.over").count()).toBe(0);
});

test("a file that is no picture is refused with its name", async () => {
  await page.goto(`${studio.address}/#/teach`);
  await page.getByText("Pictures", { exact: true }).click();
  await page
    .locator("input[type=file]")
    .first()
    .setInputFiles({ name: "broken.jpg", mimeType: "image/jpeg", buffer: Buffer.from("not a picture") });
  await page.getByText("“broken.jpg” is no picture").waitFor();
});
