// What the page asks for is what openapi.yaml offers.
import { readFileSync } from "node:fs";
import { afterAll, beforeAll, expect, test, vi } from "vitest";
import * as calls from "./calls";

type Call = (...given: unknown[]) => unknown;

/// "GET /api/objects/{object}" of every operation.
function offered(): RegExp[] {
  const found: RegExp[] = [];
  let path = "";
  for (const line of readFileSync("../openapi.yaml", "utf8").split("\n")) {
    path = /^ {2}(\/.*):$/.exec(line)?.[1] ?? path;
    const method = /^ {4}(get|put|post|patch|delete):$/.exec(line)?.[1];
    if (method) found.push(new RegExp(`^${method.toUpperCase()} ${path.replace(/\{\w+\}/g, "[^/]+")}$`));
  }
  return found;
}

const asked: string[] = [];

beforeAll(() => {
  vi.stubGlobal("fetch", async (url: string, init: RequestInit) => {
    asked.push(`${init.method} ${url.split("?")[0]}`);
    return new Response("{}", { headers: { "Content-Type": "application/json" } });
  });
});
afterAll(() => vi.unstubAllGlobals());

test("every call of the page is an operation of the server", async () => {
  for (const call of Object.values(calls) as Call[]) {
    const first = call === (calls.add_impostor as Call) ? { box: [1, 2, 3, 4] } : "a/b";
    const asks = asked.length;
    const answer = call(first, {}, "c");
    if (typeof answer === "string") asked.push(`GET ${answer.split("?")[0]}`);
    else await answer;
    expect(asked.length).toBe(asks + 1);
  }
  const operations = offered();
  expect(operations.length).toBeGreaterThan(30);
  expect(asked.filter((what) => !operations.some((operation) => operation.test(what)))).toEqual([]);
});
