// SPDX-License-Identifier: MIT
// Measures whether the demo scenes run in real time beside a page that draws them: simulated seconds a second of the clock and the
// server's least factor, processor time of the server a step, and of server, page and drawing a second. This is not a test; other work on the machine counts against a scene.
// Usage (in studio/): node ../tests/studio/measure_demos.mjs [SECONDS=8] [NAME…]
import { readdirSync, readFileSync } from "node:fs";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";
import { openBrowser, openStudio } from "./browser.mjs";
import { browserTime, timeOf } from "./processor_time.mjs";
import { findProgram, prepareDatabase, RealServer } from "./real_server.mjs";
import { commandFrom } from "./session.mjs";

const SCENES = join(dirname(fileURLToPath(import.meta.url)), "..", "..", "data", "scenes");
const STEPS_A_SECOND = 60;

const [seconds = "8", ...wanted] = process.argv.slice(2);
const program = findProgram();
const server = new RealServer(program, prepareDatabase(program));
const address = await server.start({ embody_scene: 1, title: "Empty", entities: [] });
const browser = await openBrowser();

/** What has been spent so far, s. */
const spent = () => ({ clock: performance.now() / 1000, server: timeOf(server.process.pid), ...browserTime() });

for (const file of readdirSync(SCENES).filter((name) => name.endsWith(".json"))) {
  const name = file.replace(/\.json$/, "");
  if (wanted.length > 0 && !wanted.includes(name)) continue;
  const page = await openStudio(browser, address, { width: 1280, height: 800 });
  const scene = JSON.parse(readFileSync(join(SCENES, file)));
  await commandFrom(page, "scene.load", { scene });
  await page.waitForFunction((title) => document.title.includes(title), scene.title);
  await page.waitForFunction(() => window.embody.loading() === 0, null, { timeout: 120000 });
  const start = spent();
  await commandFrom(page, "simulation.play", {});
  const factors = [];
  for (let waited = 0; waited < Number(seconds); ++waited) {
    await page.waitForTimeout(1000);
    factors.push(await page.evaluate(() => window.embody.statistics()?.real_time_factor ?? 0));
  }
  await commandFrom(page, "simulation.pause", {});
  const end = spent();
  await page.waitForFunction(() => window.embody.simulation().state === "paused");
  const clock = end.clock - start.clock;
  const simulated = await page.evaluate(() => window.embody.simulation().time);
  const a_second = (kind) => +((end[kind] - start[kind]) / clock).toFixed(2);
  console.log(
    JSON.stringify({
      demo: name,
      real_time: +(simulated / clock).toFixed(2),
      slowest: +Math.min(...factors).toFixed(2),
      server_ms_a_step: +((1000 * (end.server - start.server)) / (simulated * STEPS_A_SECOND)).toFixed(1),
      server: a_second("server"),
      page: a_second("page"),
      drawing: a_second("gpu"),
    }),
  );
  await page.context().close();
}
await browser.close();
await server.discard();
