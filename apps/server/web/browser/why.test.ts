import { join } from "node:path";
import { afterAll, beforeAll, expect, test } from "vitest";
import type { Page } from "playwright-core";
import { check_for_everybody } from "./axe";
import { demo, Studio } from "./studio";

let studio: Studio;
let page: Page;

beforeAll(async () => {
  studio = await Studio.start();
  await studio.teach("poster", ["cover"]);
  await studio.teach("mug", ["y000", "y030", "y330"]);
  await studio.teach("muesli", ["y000", "y036"]);
  page = await studio.open("#/try", { bypassCSP: true });
});
afterAll(() => studio.stop());

/// Is the picture of matches and votes there, both halves of it?
async function drawn(): Promise<boolean> {
  const pictures = page.locator(".why-half img");
  if ((await pictures.count()) !== 2) return false;
  return page.evaluate(() => [...document.querySelectorAll<HTMLImageElement>(".why-half img")].every((one) => one.naturalWidth > 0));
}

test("a picture that is tried tells why an object is not found in it", async () => {
  await page.locator("input[type=file]").first().setInputFiles(join(demo, "test/reading.jpg")); // no muesli in it
  await page.getByRole("button", { name: "Why not?" }).click();
  await page.getByText("Not found.").waitFor();
  expect(await page.getByLabel("Object").inputValue()).toBe("muesli");
  expect(await page.locator(".why-reason").textContent()).toMatch(/^Not found. [A-Z].+\.$/);
  expect(await page.locator(".why-end").count()).toBe(1);
  await expect.poll(drawn).toBe(true);
  await page.getByText("What decides here").waitFor();
  await page.getByText("To this option").waitFor();
  await studio.shoot(page, "why-not");
  await check_for_everybody(page, "why not");
});

test("of an object that was found it says what speaks for it", async () => {
  await page.getByLabel("Object").selectOption("poster");
  await page.getByText("Found.", { exact: true }).waitFor();
  expect(await page.locator(".why-end").count()).toBe(0);
  await expect.poll(drawn).toBe(true);
  await studio.shoot(page, "why-found");
});

test("the option that decides is one click away", async () => {
  await page.getByText("To this option").click();
  await page.getByRole("heading", { name: "Settings" }).waitFor();
  await expect.poll(() => page.evaluate(() => document.activeElement?.getAttribute("type"))).toBe("range");
  expect(await page.locator("dialog").count()).toBe(0);
});

test("an option for experts is unfolded for whoever comes for it", async () => {
  await page.goto(`${studio.address}/#/settings/recognize.match.max_ratio`);
  await expect.poll(() => page.evaluate(() => document.activeElement?.closest(".setting")?.id)).toBe(
    "recognize.match.max_ratio",
  );
});

test("the live picture is asked about as it was then, also on a phone", async () => {
  await studio.show("test/strangers.jpg");
  const phone = await studio.open("#/live", { viewport: { width: 360, height: 740 }, isMobile: true, bypassCSP: true });
  page = phone;
  await phone.getByRole("button", { name: "Why not?" }).click();
  await phone.getByText("Not found.").waitFor();
  const said = await phone.locator(".why-reason").textContent();
  await studio.show("test/breakfast.jpg");
  await expect.poll(drawn).toBe(true);
  expect(await phone.locator(".why-reason").textContent()).toBe(said);
  await studio.shoot(phone, "why-phone");
  await check_for_everybody(phone, "why not on a phone");
  await phone.getByRole("button", { name: "Close" }).click();
  expect(await phone.getByRole("dialog").count()).toBe(0);
});

test("the HTTP interface is there to be read, and leads on by links", async () => {
  await page.goto(`${studio.address}/#/api/recognize`);
  const entry = page.locator("#ref-recognize");
  await entry.getByRole("link", { name: "Recognition" }).waitFor();
  await entry.getByText(`curl --data-binary @picture.jpg ${studio.address}/api/recognize`).waitFor();
  await studio.shoot(page, "api-phone");
  await entry.getByRole("link", { name: "Recognition" }).click();
  await page.locator("#ref-Recognition").getByText("detections").waitFor();
  expect(await page.locator("summary .ref-method").count()).toBeGreaterThan(40);
});
