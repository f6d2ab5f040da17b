// What is wrong for everybody: contents wider than the page, scroll bars within it, complaints of axe.
import { readFileSync } from "node:fs";
import { createRequire } from "node:module";
import { expect } from "vitest";
import type { Page } from "playwright-core";

const axe = readFileSync(createRequire(import.meta.url).resolve("axe-core/axe.min.js"), "utf8");

/// `page` must have been opened with bypassCSP.
export async function check_for_everybody(page: Page, what: string): Promise<void> {
  expect(await page.evaluate(overflowing), what).toEqual([]);
  await page.evaluate(axe);
  expect(await page.evaluate(axe_complaints), what).toEqual([]);
}

function overflowing(): string[] {
  const found = document.documentElement.scrollWidth > innerWidth ? ["page"] : [];
  for (const element of document.querySelectorAll("main *:not(dialog)")) {
    const style = getComputedStyle(element);
    if (/auto|scroll/.test(style.overflowX + style.overflowY)) found.push(element.outerHTML.slice(0, 80));
  }
  for (const dialog of document.querySelectorAll("dialog"))
    if (dialog.scrollWidth > dialog.clientWidth) found.push("dialog");
  return found;
}

async function axe_complaints(): Promise<string[]> {
  const { axe } = globalThis as unknown as {
    axe: { run: () => Promise<{ violations: { id: string; nodes: { html: string; failureSummary: string }[] }[] }> };
  };
  const { violations } = await axe.run();
  return violations.map(({ id, nodes }) => `${id}: ${nodes.map((node) => node.html + node.failureSummary).join("; ")}`);
}
