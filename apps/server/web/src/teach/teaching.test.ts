import { beforeEach, expect, test, vi } from "vitest";
import type { TakenView, TeachSession } from "../api/types";
import { idle_sides, next_side, Teaching } from "./teaching";

function view(yaw: number | null, adds_little = false): TakenView {
  return { adds_little, view: "1", yaw, width: 4, height: 3, features: 9, coverage: 1, method: "mask", source: "", taught_at: "" };
}

function session(yaws: (number | null)[], next_yaw: number | null = null, known_yaws: number[] = []): TeachSession {
  return { session: "s1", object: null, known_yaws, seconds: 2, background: false, views: yaws.map((yaw) => view(yaw)), next_yaw, enough: false };
}

let asked: string[];
let answers: Record<string, unknown>;

beforeEach(() => {
  asked = [];
  answers = { "POST /api/teach-sessions": session([]) };
  vi.stubGlobal("fetch", async (url: string, init: RequestInit) => {
    const what = `${init.method} ${url}`;
    asked.push(what);
    return new Response(JSON.stringify(answers[what] ?? {}), { headers: { "Content-Type": "application/json" } });
  });
});

test("the next side is the largest gap, else a turn on from the last", () => {
  expect(next_side(session([]))).toBe(0);
  expect(next_side(session([null]))).toBe(0);
  expect(next_side(session([0]))).toBe(30);
  expect(next_side(session([330]))).toBe(0);
  expect(next_side(session([0, 30], 178))).toBe(180);
  expect(next_side(session([], 58, [0, 30]))).toBe(60);
});

test("a side is idle when only views that add little show it", () => {
  const taken = { ...session([]), views: [view(0), view(60, true), view(5, true), view(90, true), view(null, true)] };
  expect(idle_sides(taken)).toEqual([60, 90]);
  expect(idle_sides({ ...taken, known_yaws: [90] })).toEqual([60]);
});

test("the clock runs from the beginning, and anew after starting over", async () => {
  vi.spyOn(performance, "now").mockReturnValue(1000);
  const teaching = new Teaching();
  expect(teaching.begun.value).toBe(1000);
  vi.spyOn(performance, "now").mockReturnValue(5000);
  await teaching.look({}); // the server's session begins only now
  expect(teaching.begun.value).toBe(1000);
  await teaching.discard();
  expect(teaching.begun.value).toBe(5000);
  teaching.adopt(session([0]));
  expect(teaching.begun.value).toBe(3000);
  vi.restoreAllMocks();
});

test("an object that gets further views goes on where they end", async () => {
  answers["POST /api/teach-sessions?object=mug"] = session([], 60, [0, 30]);
  const teaching = new Teaching("mug");
  await teaching.look({});
  expect(teaching.yaw.value).toBe(60);
});

test("a session begins with the first need and only once", async () => {
  const teaching = new Teaching();
  await Promise.all([teaching.look({}), teaching.look({})]);
  expect(asked.filter((what) => what === "POST /api/teach-sessions")).toHaveLength(1);
});

test("a view that is refused is not accepted", async () => {
  answers["POST /api/teach-sessions/s1/proposal?yaw=0"] = { usable: false, advice: ["Move the object."] };
  const teaching = new Teaching();
  expect(await teaching.take({})).toBe(false);
  expect(asked).not.toContain("POST /api/teach-sessions/s1/views?yaw=0");
  expect(teaching.proposal.value!.advice).toEqual(["Move the object."]);
  expect(teaching.taking.value).toBe(false);
});

test("a view that is taken moves the ring on", async () => {
  answers["POST /api/teach-sessions/s1/proposal?yaw=0"] = { usable: true };
  answers["POST /api/teach-sessions/s1/views?yaw=0"] = session([0], 30);
  const teaching = new Teaching();
  expect(await teaching.take({})).toBe(true);
  expect(teaching.yaw.value).toBe(30);
  expect(teaching.proposal.value).toBeNull();
});

test("a cover has no side, before and after", async () => {
  answers["POST /api/teach-sessions/s1/proposal?whole=true"] = { usable: true };
  answers["POST /api/teach-sessions/s1/views"] = session([null]);
  const teaching = new Teaching();
  teaching.yaw.value = null;
  expect(await teaching.take({ whole: true })).toBe(true);
  expect(teaching.yaw.value).toBeNull();
});

test("only a session without views is thrown away when the page goes", async () => {
  const teaching = new Teaching();
  teaching.adopt(session([0]));
  teaching.leave();
  expect(asked).toEqual([]);
  teaching.adopt(session([]));
  teaching.leave();
  expect(asked).toEqual(["DELETE /api/teach-sessions/s1"]);
  expect(teaching.session.value).toBeNull();
});

test("a page that was left begins no session", async () => {
  const teaching = new Teaching();
  const looking = teaching.look({});
  teaching.close();
  await expect(looking).rejects.toThrow();
  expect(asked).toEqual([]);
});

test("looks do not overtake each other", async () => {
  const teaching = new Teaching();
  const both = [teaching.look({ roi: "first" }), teaching.look({ roi: "second" })];
  expect(asked).toHaveLength(0);
  await Promise.all(both);
  expect(asked.slice(1).map((what) => what.split("roi=")[1])).toEqual(["first", "second"]);
});

test("a look that fails says why, and the next one works", async () => {
  const teaching = new Teaching();
  await teaching.look({});
  const working = fetch;
  vi.stubGlobal("fetch", async () => new Response('{"error": {"message": "No camera."}}', { status: 503 }));
  await expect(teaching.look({})).rejects.toThrow("No camera.");
  expect(teaching.trouble.value).toBe("No camera.");
  vi.stubGlobal("fetch", working);
  await teaching.look({});
  expect(teaching.trouble.value).toBe("");
});
