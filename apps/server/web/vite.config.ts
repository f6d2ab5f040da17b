import { readFileSync } from "node:fs";
import { defineConfig, type Plugin } from "vitest/config";

const kInside = ["preact", "@preact/signals", "@preact/signals-core"];

/// Licences of what the page contains.
function licences(): Plugin {
  return {
    name: "licences",
    generateBundle() {
      const texts = kInside.map((name) => `${name}\n\n${readFileSync(`node_modules/${name}/LICENSE`, "utf8")}`);
      this.emitFile({ type: "asset", fileName: "third-party.txt", source: texts.join("\n\n") });
    },
  };
}

// File names carry no hash: the server embeds them by name and answers with an ETag.
export default defineConfig({
  base: "./",
  plugins: [licences()],
  build: {
    target: "es2022",
    modulePreload: false,
    cssCodeSplit: false,
    assetsInlineLimit: 0,
    rollupOptions: {
      output: { entryFileNames: "app.js", assetFileNames: "app.[ext]", inlineDynamicImports: true },
    },
  },
  server: { proxy: { "/api": "http://127.0.0.1:8080" } },
  test: { include: ["src/**/*.test.ts"] },
});
