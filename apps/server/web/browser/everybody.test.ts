// For everybody: small and large screens, light and dark, keyboard and screen reader.
import { afterAll, beforeAll, expect, test } from "vitest";
import type { Page } from "playwright-core";
import { check_for_everybody } from "./axe";
import { Studio } from "./studio";

const kPages = ["#/live", "#/objects", "#/objects/mug", "#/teach", "#/try", "#/settings", "#/api"];
const kSizes = [
  { name: "phone", viewport: { width: 360, height: 740 }, isMobile: true, colorScheme: "light" as const },
  { name: "phone-dark", viewport: { width: 360, height: 740 }, isMobile: true, colorScheme: "dark" as const },
  { name: "desk", viewport: { width: 1280, height: 800 }, colorScheme: "light" as const },
  { name: "desk-dark", viewport: { width: 1280, height: 800 }, colorScheme: "dark" as const },
  { name: "wide", viewport: { width: 1920, height: 1080 }, colorScheme: "light" as const },
  { name: "wide-dark", viewport: { width: 1920, height: 1080 }, colorScheme: "dark" as const },
];

let studio: Studio;

beforeAll(async () => {
  studio = await Studio.start();
  await studio.teach("mug", ["y000", "y030", "y300", "y330"]);
  await studio.teach("tea-cherry", ["y000", "y036", "y324"]);
  await studio.teach("poster", ["cover"]);
  await studio.show("test/reading.jpg");
});
afterAll(() => studio.stop());

async function settle(page: Page, hash: string): Promise<void> {
  await page.goto(`${studio.address}/${hash}`);
  await page.locator("main h1").first().waitFor({ state: "attached" });
  if (hash === "#/live") await page.locator(".found-name").first().waitFor();
  if (hash.startsWith("#/objects")) await page.locator(".object img").first().waitFor();
}

for (const { name, ...options } of kSizes)
  test(`${name}: nothing overflows, nothing scrolls inside, axe has no complaint`, async () => {
    const page = await studio.open("#/live", { ...options, bypassCSP: true });
    for (const hash of kPages) {
      await settle(page, hash);
      await studio.shoot(page, `${name}-${hash.slice(2).replace("/", "-")}`);
      await page.evaluate(unfold);
      await check_for_everybody(page, hash);
    }
  });

function unfold(): void {
  for (const details of document.querySelectorAll("details")) details.open = true;
}

test("the keyboard alone gets from the live picture into a new object", async () => {
  await studio.show("train/mug/background.jpg");
  const page = await studio.open("#/live");
  await page.getByRole("link", { name: "New object" }).waitFor();
  const focused = (): Promise<string> => page.evaluate(() => document.activeElement?.textContent?.trim() ?? "");
  for (let i = 0; i < 12 && (await focused()) !== "New object"; ++i) await page.keyboard.press("Tab");
  await page.keyboard.press("Enter");
  await page.getByRole("button", { name: "The table is empty" }).waitFor();
  for (let i = 0; i < 12 && (await focused()) !== "The table is empty"; ++i) await page.keyboard.press("Tab");
  await page.keyboard.press("Enter");
  await page.locator(".verdict").waitFor();
  await studio.show("train/mug/y060.jpg");
  await page.locator(".verdict.good").waitFor();
  expect(await focused()).toBe("Take this view");
  await page.keyboard.press("Enter");
  await page.getByText("1 view taken").waitFor();
  const tab_to = async (what: string): Promise<void> => {
    for (let i = 0; i < 20 && !(await page.evaluate((s) => document.activeElement!.matches(s), what)); ++i)
      await page.keyboard.press("Tab");
  };
  await tab_to(".side.next");
  await page.keyboard.press("ArrowRight");
  expect(await page.locator(".side:focus").getAttribute("aria-label")).toContain("missing");
  expect(await page.locator(".side.next").getAttribute("aria-checked")).toBe("true");
  await tab_to("input[autocomplete=off]");
  await page.keyboard.type("cup");
  await tab_to("button.primary:not([aria-disabled])");
  expect(await focused()).toContain("Save");
  await page.keyboard.press("Enter");
  await page.getByText("“cup” is known").waitFor();
});

type Watched = typeof globalThis & { shifts: number[] };

/// Counts from the next load on what moves though nobody has touched anything.
async function watch_shifts(page: Page): Promise<void> {
  await page.addInitScript(() => {
    const shifts: number[] = ((globalThis as unknown as Watched).shifts = []);
    new PerformanceObserver((list) => {
      for (const entry of list.getEntries() as unknown as { value: number; hadRecentInput: boolean }[])
        if (!entry.hadRecentInput) shifts.push(entry.value);
    }).observe({ type: "layout-shift", buffered: true });
  });
  await page.reload();
}

async function shifted(page: Page): Promise<number> {
  const shifts = await page.evaluate(() => (globalThis as unknown as Watched).shifts);
  return shifts.reduce((sum, value) => sum + value, 0);
}

test("nothing jumps while the live picture comes up", async () => {
  await studio.show("test/reading.jpg");
  const page = await studio.open("#/live");
  await watch_shifts(page);
  await page.locator(".found-name").first().waitFor();
  expect(await shifted(page)).toBeLessThan(0.05);
});

test("nothing jumps while the page looks at what is taught", async () => {
  const page = await studio.open("#/teach");
  await watch_shifts(page);
  await begin_teaching(page);
  await studio.show("train/mug/background.jpg");
  await page.locator(".verdict.bad").waitFor();
  await studio.show("train/mug/y060.jpg");
  await page.locator(".verdict.warn, .verdict.good").waitFor();
  expect(await shifted(page)).toBeLessThan(0.05);
  await start_over(page);
});

/// Until one view is taken.
async function begin_teaching(page: Page): Promise<void> {
  await studio.show("train/mug/background.jpg");
  await page.getByRole("button", { name: "The table is empty" }).click();
  await page.locator(".verdict.bad").waitFor();
  await studio.show("train/mug/y060.jpg");
  await page.locator(".verdict.good").waitFor();
  await page.getByRole("button", { name: "Take this view" }).click();
  await page.getByText("1 view taken").waitFor();
  await page.locator(".verdict.warn").waitFor();
}

async function start_over(page: Page): Promise<void> {
  await page.getByRole("button", { name: "Start over" }).click();
  await page.getByRole("dialog").getByRole("button", { name: "Start over" }).click();
  await page.getByText("1 view taken").waitFor({ state: "detached" });
}

test.each(kSizes)("teaching is for everybody: $name", async ({ name, ...options }) => {
  const page = await studio.open("#/teach", { ...options, bypassCSP: true });
  await begin_teaching(page);
  await studio.shoot(page, `${name}-teaching`);
  await check_for_everybody(page, "teaching");
  await start_over(page);
});

test("screen readers hear of verdicts and names when they change, not of every look", async () => {
  await studio.show("test/reading.jpg");
  const page = await studio.open("#/live");
  await page.getByRole("status").filter({ hasText: "mug" }).waitFor({ state: "attached" });
  await page.goto(`${studio.address}/#/teach`);
  await begin_teaching(page);
  const announced = page.getByRole("status").filter({ hasText: "known already" });
  await announced.waitFor({ state: "attached" });
  expect(await page.locator(".verdict").getAttribute("role")).toBeNull();
  await start_over(page);
});
