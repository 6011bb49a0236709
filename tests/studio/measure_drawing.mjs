// SPDX-License-Identifier: MIT
// Measures what pictures of many real models cost: processor time of the browser's processes, draw calls, triangles, garbage. This is
// not a test.
// Usage (in studio/): node ../tests/studio/measure_drawing.mjs DATABASE [COUNT=200] [QUALITY=low] [PICTURE.png]
// EMBODY_PROGRAM names the program. The models stand in rows as in a large shop, 2.2 m apart; the camera goes slowly past them.
import { openBrowser, openStudio, takePicture } from "./browser.mjs";
import { browserTime } from "./processor_time.mjs";
import { findProgram, RealServer } from "./real_server.mjs";
import { commandFrom } from "./session.mjs";

const [database, count = "200", quality = "low", picture] = process.argv.slice(2);
const PICTURES = 30;
const SPACING = 2.2;

const server = new RealServer(findProgram(), database);
const address = await server.start({ embody_scene: 1, title: "Empty", entities: [] });
const browser = await openBrowser(["--enable-precise-memory-info"]);
const page = await openStudio(browser, address, { quality });

/** Every so many-th model of the catalogue, so that the largest are among them. */
async function keysOf(wanted) {
  const { total } = await commandFrom(page, "catalog.search", { words: "", limit: 1 });
  const keys = [];
  for (let offset = 0; offset < total; offset += 100)
    keys.push(...(await commandFrom(page, "catalog.search", { words: "", offset, limit: 100 })).models.map(({ key }) => key));
  return Array.from({ length: wanted }, (_, at) => keys[Math.floor((at * keys.length) / wanted) % keys.length]);
}

const wanted = Number(count);
const side = Math.ceil(Math.sqrt(wanted));
const middle = (SPACING * (side - 1)) / 2;
const entities = (await keysOf(wanted)).map((model, at) => ({
  index: at + 2,
  model,
  pose: { position: [SPACING * (at % side) - middle, 0, SPACING * Math.floor(at / side) - middle] },
}));
const floor = { index: 1, name: "Floor", shape: { type: "plane" } };
const camera = { position: [0, 1.7, middle + 4], target: [0, 0.6, 0] };
const scene = { embody_scene: 1, title: "Shop", camera, entities: [floor, ...entities] };
const before = performance.now();
await commandFrom(page, "scene.load", { scene });
await page.waitForFunction((all) => window.embody.entities().length === all && window.embody.loading() === 0, wanted + 1, { timeout: 600000 });
const loaded = performance.now() - before;

/** Draws so many pictures, each from a little further on, and waits for each. */
const pass = (pictures) => page.evaluate((pictures) => window.embody.measure(pictures), pictures);

await pass(5);
for (const full of [false, true]) {
  await page.evaluate((full) => window.embody.showFullDetail(full), full);
  await pass(2);
  const [start, heap] = [browserTime(), await page.evaluate(() => performance.memory.usedJSHeapSize)];
  const bytes = await pass(PICTURES);
  const end = browserTime();
  const ms = (kind) => Math.round((1000 * (end[kind] - start[kind])) / PICTURES);
  const drawn = await page.evaluate(() => window.embody.drawn());
  console.log(JSON.stringify({ models: wanted, quality, full, gpu_ms: ms("gpu"), page_ms: ms("page"), ...drawn, heap_mb: Math.round(heap / 1048576), bytes_a_picture: bytes, loaded_s: +(loaded / 1000).toFixed(1) }));
}
await page.evaluate(() => window.embody.showFullDetail(false));
if (picture) await takePicture(page, picture);
if (page.faults.length) console.log("faults:", page.faults.slice(0, 3));
await browser.close();
await server.discard();
process.exit(0);
