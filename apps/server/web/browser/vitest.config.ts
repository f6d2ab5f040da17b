import { defineConfig } from "vitest/config";

// One browser and one server at a time: the machine is to measure the page, not the crowd.
export default defineConfig({
  test: {
    include: ["browser/**/*.test.ts"],
    fileParallelism: false,
    testTimeout: 120_000,
    hookTimeout: 60_000,
    expect: { poll: { timeout: 40_000 } },
  },
});
