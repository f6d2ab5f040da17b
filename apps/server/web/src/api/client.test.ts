import { afterEach, expect, test, vi } from "vitest";
import { access, ApiError, ask, path_of } from "./client";

afterEach(() => vi.unstubAllGlobals());

function answer(status: number, body: string, type = "application/json"): void {
  vi.stubGlobal("fetch", async () => new Response(body, { status, headers: { "Content-Type": type } }));
}

test("names are encoded, a slash too; what is not given is left out", () => {
  expect(path_of(["objects", "a/b c"], { width: 320, roi: undefined })).toBe("/api/objects/a%2Fb%20c?width=320");
  expect(path_of(["objects"])).toBe("/api/objects");
});

test("an error of the server is its sentence", async () => {
  answer(409, '{"error": {"code": "already_exists", "message": "There is a mug."}}');
  await expect(ask("POST", ["x"])).rejects.toMatchObject({ status: 409, code: "already_exists", message: "There is a mug." });
});

test("an answer that is no JSON is an error with its status", async () => {
  answer(502, "<html>", "text/html");
  await expect(ask("GET", ["x"])).rejects.toThrow("502");
});

test("no answer is an error that says so", async () => {
  vi.stubGlobal("fetch", async () => Promise.reject(new TypeError("Failed to fetch")));
  await expect(ask("GET", ["x"])).rejects.toEqual(expect.any(ApiError));
  await expect(ask("GET", ["x"])).rejects.toThrow("does not answer");
});

test("a login that has run out is noticed", async () => {
  access.value = { token_needed: true, authenticated: true, version: "1" };
  answer(401, '{"error": {"code": "unauthorized", "message": "Log in."}}');
  await expect(ask("GET", ["x"])).rejects.toThrow("Log in.");
  expect(access.value.authenticated).toBe(false);
});
