// SPDX-License-Identifier: MIT
// Measures scrolling through the model browser: frame times, elements, memory. This is not a test.
// Usage (in studio/): node ../tests/studio/measure_scrolling.mjs DATABASE [PICTURE.png]
// EMBODY_PROGRAM names the program; use a database that `embody bench catalogue` has filled.
import { readFileSync } from "node:fs";
import { openBrowser, openStudio, takePicture } from "./browser.mjs";
import { findProgram, RealServer } from "./real_server.mjs";

const [database, picture] = process.argv.slice(2);
const server = new RealServer(findProgram(), database);
const address = await server.start({ embody_scene: 1, title: "Empty", entities: [] });
const browser = await openBrowser();
const page = await openStudio(browser, address);
await page.waitForSelector('[data-testid="model-tile"]');
// Stops the 3D view, because only the list is measured.
await page.evaluate(() => window.embody.halt());

/** Scrolls by `pixels` in each of `frames` frames. */
const scroll = (pixels, frames) =>
  page.evaluate(
    ([pixels, frames]) =>
      new Promise((resolve) => {
        const grid = document.querySelector('[data-testid="model-grid"]');
        const times = [];
        let elements = 0;
        let last = performance.now();
        const step = (now) => {
          times.push(now - last);
          last = now;
          elements = Math.max(elements, document.querySelectorAll("*").length);
          grid.scrollTop += pixels;
          if (times.length < frames) requestAnimationFrame(step);
          else {
            times.shift();
            times.sort((a, b) => a - b);
            const at = (share) => +times[Math.floor((times.length - 1) * share)].toFixed(1);
            const tiles = grid.querySelectorAll('[data-testid="model-tile"]').length;
            resolve({ median_ms: at(0.5), p95_ms: at(0.95), worst_ms: at(1), elements, tiles });
          }
        };
        requestAnimationFrame(step);
      }),
    [pixels, frames],
  );
const height = await page.evaluate(() => document.querySelector('[data-testid="model-grid"]').scrollHeight);
const memory = () => page.evaluate(() => Math.round(performance.memory.usedJSHeapSize / 1048576));
const serverMemory = () => Math.round(Number(/VmRSS:\s+(\d+)/.exec(readFileSync(`/proc/${server.process.pid}/status`, "utf8"))[1]) / 1024);
const row = async (what, result) => console.log(JSON.stringify({ what, ...result, page_heap_mb: await memory(), server_mb: serverMemory() }));

console.log(`${await page.textContent('[data-testid="result-count"]')}, list ${height} px high`);
await row("slowly, 20 px a frame", await scroll(20, 300));
await row("fast, 300 px a frame", await scroll(300, 300));
await row("all through, in 600 frames", await scroll(Math.ceil(height / 590), 600));
if (picture) await takePicture(page, picture);
if (page.faults.length) console.log("faults:", page.faults.slice(0, 3));
await browser.close();
await server.discard();
process.exit(0);
