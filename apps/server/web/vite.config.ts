import { readFileSync } from "node:fs";
import { defineConfig, type Plugin } from "vitest/config";
import { parse } from "yaml";

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

/// The description of the HTTP interface as data: import api from "virtual:openapi".
function openapi(): Plugin {
  const name = "virtual:openapi";
  return {
    name: "openapi",
    resolveId: (id) => (id === name ? "\0" + name : undefined),
    load(id) {
      if (id !== "\0" + name) return;
      const json = JSON.stringify(parse(readFileSync("../openapi.yaml", "utf8")));
      return `export default JSON.parse(${JSON.stringify(json)})`;
    },
  };
}

// File names carry no hash: the server embeds them by name and answers with an ETag.
export default defineConfig({
  base: "./",
  plugins: [licences(), openapi()],
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
