// SPDX-License-Identifier: MIT
// Loads parts of the Studio's source in Node.
import { createRequire } from "node:module";
import { fileURLToPath } from "node:url";

const STUDIO = new URL("../../studio/", import.meta.url);
const require = createRequire(new URL("package.json", STUDIO));
// Vite brings its own compiler.
const { buildSync } = createRequire(require.resolve("vite"))("esbuild");

/** The exports of a module with this text; paths in it begin at studio/src. */
export async function loadSource(text) {
  const stdin = { contents: text, resolveDir: fileURLToPath(new URL("src/", STUDIO)), loader: "ts" };
  const [program] = buildSync({ stdin, bundle: true, format: "esm", write: false }).outputFiles;
  return import(`data:text/javascript;base64,${Buffer.from(program.contents).toString("base64")}`);
}

/** Numbers of 0 to 1 that are the same in each run (mulberry32). */
export function randomNumbers(seed) {
  return () => {
    seed = (seed + 0x6d2b79f5) | 0;
    let t = Math.imul(seed ^ (seed >>> 15), 1 | seed);
    t = (t + Math.imul(t ^ (t >>> 7), 61 | t)) ^ t;
    return ((t ^ (t >>> 14)) >>> 0) / 4294967296;
  };
}
