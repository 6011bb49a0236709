// SPDX-License-Identifier: MIT
import { defineConfig } from "vite";

// `npm run dev` serves the sources and hands everything else to a running `embody serve`; EMBODY_SERVER names another address.
const server = process.env.EMBODY_SERVER ?? "http://127.0.0.1:8420";
const handedOn = { target: server, changeOrigin: true, headers: { origin: server } };

export default defineConfig({
  base: "./",
  build: {
    target: "es2022",
    // three.js is one library of about 700 kB; splitting it would only add a round trip.
    chunkSizeWarningLimit: 1200,
    rollupOptions: { output: { manualChunks: { three: ["three"] } } },
  },
  worker: { format: "es" },
  server: {
    proxy: {
      "/ws": { ...handedOn, ws: true },
      "/models": handedOn,
      "/import": handedOn,
      "/api": handedOn,
      "/scene.json": handedOn,
    },
  },
});
