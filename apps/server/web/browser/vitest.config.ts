import { defineConfig } from "vitest/config";

const kPatienceMs = 20_000;

/// How much longer than alone this machine takes now: others may use its processors, too.
function slowness(): number {
  const begin = performance.now();
  const used = process.cpuUsage();
  while (performance.now() - begin < 300);
  const { user } = process.cpuUsage(used);
  return Math.min(4, Math.max(1, (performance.now() - begin) / (user / 1000)));
}

// One browser and one server at a time: the machine is to measure the page, not the crowd. Tests of
// a file go on from one another, so the first that fails ends the run.
const patience_ms = Math.round(kPatienceMs * slowness());
export default defineConfig({
  test: {
    include: ["browser/**/*.test.ts"],
    fileParallelism: false,
    bail: 1,
    testTimeout: 6 * patience_ms,
    hookTimeout: 3 * patience_ms,
    expect: { poll: { timeout: patience_ms } },
    env: { POSEVOTE_PATIENCE_MS: String(patience_ms) },
  },
});
