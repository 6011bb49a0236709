// SPDX-License-Identifier: MIT
// Takes the pictures of the gallery: each demo scene, in full drawing, at a moment when something happens.
//   cd studio && node ../tests/studio/take_gallery.mjs [NAME…]
import { mkdirSync, readdirSync, readFileSync, writeFileSync } from "node:fs";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";
import { openBrowser, openStudio, pictureOfScene } from "./browser.mjs";
import { findProgram, prepareDatabase, RealServer } from "./real_server.mjs";
import { commandFrom } from "./session.mjs";

const root = join(dirname(fileURLToPath(import.meta.url)), "..", "..");
const SCENES = join(root, "data", "scenes");
const PICTURES = join(root, "studio", "public", "gallery");
const [WIDTH, HEIGHT] = [640, 400];
/** Simulated seconds until the picture; one second where nothing is said. */
const MOMENTS = { awning: 7, basin: 9.5, bathtub: 1.2, beach_balls: 0.55, breaking_plates: 0.75, card_house: 0, domino_spiral: 7, dominoes: 1, furnished_room: 1, honey_on_bread: 2, hourglass: 1.5, melting_ice: 5.13, newtons_cradle: 0.5, pool_table: 0.45, sheet_metal: 1.5, stack_of_boxes: 0, tablecloth: 2.5, torn_paper: 0.42, trampoline: 0.75, wires: 3, wrecking_ball: 1.15 };

const program = findProgram();
if (!program) throw new Error("the program embody is not built");
mkdirSync(PICTURES, { recursive: true });
const server = new RealServer(program, prepareDatabase(program));
const browser = await openBrowser();
const wanted = process.argv.slice(2);
const address = await server.start({ embody_scene: 1, title: "Empty", entities: [] });
for (const file of readdirSync(SCENES)) {
  const name = file.replace(/\.json$/, "");
  if (wanted.length > 0 && !wanted.includes(name)) continue;
  // A page as wide as the picture, so that nothing has to be cut off.
  const page = await openStudio(browser, address, { width: WIDTH, height: HEIGHT + 72, quality: "high" });
  const scene = JSON.parse(readFileSync(join(SCENES, file)));
  await commandFrom(page, "scene.load", { scene });
  await page.waitForFunction((title) => document.title.includes(title), scene.title);
  await page.waitForFunction(() => window.embody.loading() === 0, null, { timeout: 120000 });
  const count = Math.round((MOMENTS[name] ?? 1) * 60);
  if (count > 0) await commandFrom(page, "simulation.step", { count });
  const png = await pictureOfScene(page);
  if (process.env.EMBODY_TEST_PICTURES) writeFileSync(join(process.env.EMBODY_TEST_PICTURES, `${name}.png`), png);
  const webp = await page.evaluate(
    async ([bytes, width, height]) => {
      const picture = await createImageBitmap(new Blob([Uint8Array.from(atob(bytes), (each) => each.charCodeAt(0))]));
      const canvas = new OffscreenCanvas(width, height);
      canvas.getContext("2d").drawImage(picture, 0, 0, width, height);
      const blob = await canvas.convertToBlob({ type: "image/webp", quality: 0.82 });
      return [...new Uint8Array(await blob.arrayBuffer())];
    },
    [png.toString("base64"), WIDTH, HEIGHT],
  );
  writeFileSync(join(PICTURES, `${name}.webp`), Buffer.from(webp));
  console.log(`${name}: ${webp.length} bytes`);
  await page.context().close();
}
await browser.close();
await server.discard();
