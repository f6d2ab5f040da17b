// The real server with a browser before it. POSEVOTE_PROGRAM and POSEVOTE_DEMO name the executable
// and the demo set; POSEVOTE_SHOTS, if set, a folder for all screenshots, POSEVOTE_DOCS one for those
// of docs/studio.md.
import { spawn, type ChildProcess } from "node:child_process";
import { mkdirSync, mkdtempSync, readdirSync, readFileSync, rmSync } from "node:fs";
import { createServer } from "node:net";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { afterAll } from "vitest";
import { chromium, type Browser, type BrowserContextOptions, type Page } from "playwright-core";

export const demo = needed("POSEVOTE_DEMO");
const shots = process.env.POSEVOTE_SHOTS;
const docs = process.env.POSEVOTE_DOCS;

/// Screenshots that docs/studio.md shows, and what they are called there.
const kInDocs: Record<string, string> = {
  "desk-live": "live",
  "desk-dark-live": "dark",
  "phone-live": "phone",
  teach: "teach",
  mask: "mask",
  objects: "objects",
  view: "view",
  "why-not": "why",
};

const kFrameMs = 500;
const kTicks = 100; // a second, of /proc/PID/stat
/// How long is waited for what must come; set by vitest.config.ts.
const patience_ms = Number(needed("POSEVOTE_PATIENCE_MS"));
const kFlags = [
  "--no-sandbox",
  "--disable-gpu",
  "--disable-quic",
  "--no-first-run",
  "--disable-background-networking",
  "--disable-component-update",
  "--disable-sync",
];

function needed(name: string): string {
  const value = process.env[name];
  if (!value) throw new Error(`${name} is not set`);
  return value;
}

export const picture = (path: string): Uint8Array<ArrayBuffer> => new Uint8Array(readFileSync(join(demo, path)));

export interface Options {
  arguments?: string[];
  browser_flags?: string[];
}

export class Studio {
  private constructor(
    readonly folder: string,
    readonly address: string,
    private server: ChildProcess,
    private browser: Browser,
    private said: string[],
  ) {}

  static async start(options: Options = {}): Promise<Studio> {
    const folder = mkdtempSync(join(tmpdir(), "posevote-page-"));
    const port = await free_port();
    const said: string[] = [];
    const server = serve(folder, port, options.arguments ?? ["--camera", "client"], said);
    const address = `http://127.0.0.1:${port}`;
    await answered(address, server, said);
    const browser = await chromium.launch({
      executablePath: process.env.POSEVOTE_CHROMIUM ?? "/usr/bin/chromium",
      args: [...kFlags, ...(options.browser_flags ?? [])],
    });
    return new Studio(folder, address, server, browser, said);
  }

  /// A page at `hash`; whatever it complains of makes the test fail at `stop`.
  async open(hash: string, options: BrowserContextOptions = {}): Promise<Page> {
    const context = await this.browser.newContext({ viewport: { width: 1280, height: 800 }, ...options });
    const page = await context.newPage();
    page.setDefaultTimeout(patience_ms);
    page.on("pageerror", (error) => this.complaints.push(error.message));
    page.on("console", (message) => {
      if (/Content.Security.Policy|Refused to/.test(message.text())) this.complaints.push(message.text());
    });
    page.on("request", (request) => {
      if (!request.url().startsWith(this.address) && !/^(blob|data):/.test(request.url()))
        this.complaints.push(`loaded from elsewhere: ${request.url()}`);
    });
    await page.goto(`${this.address}/${hash}`);
    return page;
  }

  readonly complaints: string[] = [];

  /// Holds a picture of the demo set before the server's camera, which sees it again and again.
  async show(path: string): Promise<void> {
    await this.stop_camera(); // a frame of the last picture that comes late would be the newest
    const seen = picture(path);
    const { frame } = await this.ask<{ frame: number }>("POST", "live/frame", seen);
    while ((await this.ask<{ frame: number }>("GET", "live")).frame < frame) await pause(20);
    let running = true;
    const posting = (async () => {
      while (running) {
        await pause(kFrameMs);
        if (running) await this.ask("POST", "live/frame", seen).catch(() => undefined);
      }
    })();
    this.stop_camera = () => {
      running = false;
      return posting;
    };
  }

  private stop_camera = (): Promise<void> => Promise.resolve();

  /// Processor time that the server has taken so far: what others do on this machine is not in it.
  server_seconds(): number {
    const [user, system] = readFileSync(`/proc/${this.server.pid}/stat`, "utf8").split(") ")[1]!.split(" ").slice(11, 13);
    return (Number(user) + Number(system)) / kTicks;
  }

  /// How much longer its work took so far than on a machine that does nothing else: the time that
  /// its threads had a processor or waited for one, over the time that they had one.
  server_slowness(): number {
    const threads = `/proc/${this.server.pid}/task`;
    let ran = 0;
    let waited = 0;
    for (const thread of readdirSync(threads)) {
      const [running, queueing] = schedule_of(`${threads}/${thread}`);
      ran += running;
      waited += queueing;
    }
    return ran > 0 ? (ran + waited) / ran : 1;
  }

  async ask<T>(method: string, path: string, body?: Uint8Array<ArrayBuffer>): Promise<T> {
    const response = await fetch(`${this.address}/api/${path}`, {
      method,
      body,
    });
    if (!response.ok) throw new Error(`${method} ${path}: ${response.status} ${await response.text()}`);
    return (await response.json()) as T;
  }

  async change(settings: Record<string, boolean | number | string>): Promise<void> {
    await this.ask("PATCH", "settings", new TextEncoder().encode(JSON.stringify(settings)));
  }

  /// Teaches without the page: views of a folder of the demo set.
  async teach(name: string, views: string[]): Promise<void> {
    for (const view of views) {
      const form = new FormData();
      form.set("picture", new Blob([picture(`train/${name}/${view}.jpg`)]), "view.jpg");
      if (view !== "cover") form.set("background", new Blob([picture(`train/${name}/background.jpg`)]), "empty.jpg");
      const yaw = view.startsWith("y") ? `?yaw=${Number(view.slice(1))}` : "";
      // Node 18 ends a form without the line break that the server's parser waits for.
      const encoded = new Response(form);
      const body = new Blob([await encoded.arrayBuffer(), "\r\n"]);
      const headers = { "Content-Type": encoded.headers.get("Content-Type")! };
      const response = await fetch(`${this.address}/api/objects/${name}/views${yaw}`, { method: "POST", body, headers });
      if (!response.ok) throw new Error(`${name} ${view}: ${await response.text()}`);
    }
  }

  async shoot(page: Page, name: string): Promise<void> {
    if (docs && kInDocs[name])
      await page.screenshot({ path: join(docs, `${kInDocs[name]}.jpg`), type: "jpeg", quality: 82 });
    if (!shots) return;
    mkdirSync(shots, { recursive: true });
    await page.screenshot({ path: join(shots, `${name}.png`) });
  }

  kill_server(): void {
    this.server.kill("SIGKILL");
  }

  async stop(): Promise<void> {
    await this.stop_camera();
    await this.browser.close();
    const ended = new Promise((done) => this.server.once("exit", done));
    if (this.server.exitCode === null && this.server.signalCode === null) {
      this.server.kill("SIGTERM");
      await ended;
    }
    rmSync(this.folder, { recursive: true });
    if (this.complaints.length) throw new Error(`${this.complaints.join("\n")}\nThe server said:\n${this.said.join("")}`);
  }
}

/// Nanoseconds on a processor, and in the queue for one; none where the thread has just ended, or the
/// kernel does not count.
function schedule_of(thread: string): [number, number] {
  try {
    const [running, queueing] = readFileSync(`${thread}/schedstat`, "utf8").split(" ").map(Number);
    return [running!, queueing!];
  } catch {
    return [0, 0];
  }
}

const running = new Set<ChildProcess>();
afterAll(() => running.forEach((server) => server.kill("SIGKILL"))); // of tests that failed half-way

function serve(folder: string, port: number, more: string[], said: string[]): ChildProcess {
  const server = spawn(
    needed("POSEVOTE_PROGRAM"),
    ["serve", "--db", join(folder, "objects.db"), "--listen", `127.0.0.1:${port}`, ...more],
    { stdio: ["ignore", "pipe", "pipe"] },
  );
  running.add(server);
  server.once("exit", () => running.delete(server));
  server.stdout!.on("data", (text) => said.push(String(text)));
  server.stderr!.on("data", (text) => said.push(String(text)));
  return server;
}

async function answered(address: string, server: ChildProcess, said: string[]): Promise<void> {
  for (;;) {
    if (server.exitCode !== null) throw new Error(`The server ended:\n${said.join("")}`);
    const response = await fetch(`${address}/api/health`).catch(() => null);
    if (response?.ok) return;
    await pause(50);
  }
}

const pause = (ms: number): Promise<void> => new Promise((done) => setTimeout(done, ms));

function free_port(): Promise<number> {
  return new Promise((done) => {
    const probe = createServer().listen(0, "127.0.0.1", () => {
      const { port } = probe.address() as { port: number };
      probe.close(() => done(port));
    });
  });
}
