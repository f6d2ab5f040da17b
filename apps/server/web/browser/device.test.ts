// A telephone teaches with its own camera, and is the robot's eye afterwards.
import { afterAll, beforeAll, expect, test } from "vitest";
import type { Page } from "playwright-core";
import { check_for_everybody } from "./axe";
import { picture, Studio } from "./studio";

let studio: Studio;
let phone: Page;

beforeAll(async () => {
  studio = await Studio.start();
  phone = await studio.open("#/live", { viewport: { width: 360, height: 740 }, isMobile: true, bypassCSP: true });
  await phone.addInitScript(become_camera);
  await phone.reload();
});
afterAll(() => studio.stop());

type Camera = typeof globalThis & { see: (base64: string) => Promise<void> };

/// What the page gets as this device's camera is a canvas on which the test puts pictures.
function become_camera(): void {
  const canvas = Object.assign(document.createElement("canvas"), { width: 1280, height: 960 });
  const pen = canvas.getContext("2d")!;
  let seen: ImageBitmap | null = null;
  setInterval(() => seen && pen.drawImage(seen, 0, 0, canvas.width, canvas.height), 50);
  navigator.mediaDevices.getUserMedia = () => Promise.resolve(canvas.captureStream());
  (globalThis as Camera).see = async (base64) => {
    const bytes = Uint8Array.from(atob(base64), (letter) => letter.charCodeAt(0));
    seen = await createImageBitmap(new Blob([bytes], { type: "image/jpeg" }));
  };
}

async function see(path: string): Promise<void> {
  await phone.evaluate((base64) => (globalThis as Camera).see(base64), Buffer.from(picture(path)).toString("base64"));
}

test("a telephone's camera teaches", async () => {
  await see("train/soup/background.jpg");
  await phone.getByRole("link", { name: "New object" }).click();
  await phone.getByText("This device", { exact: true }).click();
  await phone.getByRole("button", { name: "The table is empty", disabled: false }).click();
  await phone.locator(".verdict.bad").waitFor();
  for (const view of ["y000", "y036"]) {
    await see(`train/soup/${view}.jpg`);
    await phone.locator(".verdict.good").waitFor();
    if (view === "y036") await studio.shoot(phone, "device");
    await phone.getByRole("button", { name: "Take this view" }).click();
    await phone.getByText(view === "y000" ? "1 view taken" : "2 views taken").waitFor();
  }
  await check_for_everybody(phone, "teaching on a telephone");
  await phone.getByLabel("Name").fill("soup");
  await phone.getByRole("button", { name: "Save" }).click();
  await phone.getByText("“soup” is known").waitFor();
});

type Watch = typeof globalThis & { contradictions: number };

/// Counts the screen's pictures in which an outline is drawn while the list says that nothing is there.
function watch_contradictions(): void {
  const page = globalThis as Watch;
  page.contradictions = 0;
  const look = (): void => {
    if (document.querySelector(".found") && !document.querySelector(".detection")) page.contradictions += 1;
    requestAnimationFrame(look);
  };
  requestAnimationFrame(look);
}

test("and then shows the server what it sees", async () => {
  await phone.getByRole("button", { name: "Send this device's camera" }).click();
  await phone.locator(".detection", { hasText: "soup" }).waitFor();
  await phone.locator(".found").waitFor();
  await phone.evaluate(watch_contradictions);
  await see("train/soup/background.jpg");
  await phone.getByText("Nothing that was taught is in the picture").waitFor();
  expect(await phone.locator(".found").count()).toBe(0);
  expect(await phone.evaluate(() => (globalThis as Watch).contradictions)).toBe(0);
});
