// One way to ask the server: JSON in and out, errors as sentences, a lost login noticed.
import { signal } from "@preact/signals";
import { sentence } from "../ui/numbers";
import type { Access } from "./types";

export class ApiError extends Error {
  constructor(readonly status: number, readonly code: string, message: string) {
    super(message);
  }
}

export interface Asked {
  query?: Record<string, string | number | boolean | undefined>;
  json?: unknown;
  body?: Blob | FormData;
  signal?: AbortSignal;
  keepalive?: boolean; // also when the page is being closed
}

/// What the server lets this client do; null until it has said so.
export const access = signal<Access | null>(null);

export function path_of(parts: string[], query: Asked["query"] = {}): string {
  const given = Object.entries(query).filter(([, value]) => value !== undefined);
  const search = new URLSearchParams(given.map(([name, value]) => [name, String(value)])).toString();
  return "/api/" + parts.map(encodeURIComponent).join("/") + (search && "?" + search);
}

export async function ask<T = void>(method: string, parts: string[], asked: Asked = {}): Promise<T> {
  const response = await send(path_of(parts, asked.query), {
    method,
    body: asked.json === undefined ? asked.body : JSON.stringify(asked.json),
    headers: asked.json === undefined ? {} : { "Content-Type": "application/json" },
    signal: asked.signal,
    keepalive: asked.keepalive,
  });
  const is_json = response.headers.get("Content-Type")?.startsWith("application/json");
  return (is_json ? await response.json() : undefined) as T;
}

export async function ask_picture(method: string, parts: string[], asked: Asked = {}): Promise<Blob> {
  const { body, signal } = asked;
  return (await send(path_of(parts, asked.query), { method, body, signal })).blob();
}

/// Throws ApiError for every answer that is not a success, or when there is none.
export async function send(url: string, init: RequestInit = {}): Promise<Response> {
  let response: Response;
  try {
    response = await fetch(url, init);
  } catch (error) {
    if (init.signal?.aborted) throw error;
    throw new ApiError(0, "unreachable", "The server does not answer. Is it still running?");
  }
  if (response.ok) return response;
  if (response.status === 401 && access.value?.authenticated)
    access.value = { ...access.value, authenticated: false };
  const body = await response.json().catch(() => null);
  throw new ApiError(
    response.status,
    body?.error?.code ?? "unknown",
    sentence(body?.error?.message ?? `the server answered ${response.status} ${response.statusText}`),
  );
}

export async function fetch_picture(url: string): Promise<ImageBitmap> {
  return createImageBitmap(await (await send(url)).blob());
}
