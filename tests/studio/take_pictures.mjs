// SPDX-License-Identifier: MIT
// Takes the pictures of README and guide, in full drawing, from the Studio as it is.
//   node tests/studio/take_pictures.mjs [NAME…]
import { mkdirSync, readFileSync, writeFileSync } from "node:fs";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";
import { openBrowser, openStudio, pictureOfScene, takePicture } from "./browser.mjs";
import { Headset, wearHeadset } from "./headset.mjs";
import { findProgram, prepareDatabase, RealServer } from "./real_server.mjs";
import { commandFrom } from "./session.mjs";
import { User } from "./user.mjs";

const root = join(dirname(fileURLToPath(import.meta.url)), "..", "..");
const IMAGES = join(root, "docs", "images");
const SIZE = { width: 1280, height: 720 };
const QUALITY = 0.8;
const scratch = join(root, "build", "pictures");
mkdirSync(scratch, { recursive: true });

const program = findProgram();
if (!program) throw new Error("the program embody is not built");
const server = new RealServer(program, prepareDatabase(program));
const browser = await openBrowser();
const address = await server.start({ embody_scene: 1, title: "Empty", entities: [] });

// Full drawing takes its time without a graphics card.
const openPage = ({ prepare = async () => {}, ...options } = {}) =>
  openStudio(browser, address, { ...SIZE, quality: "high", ...options, prepare: async (page) => (page.setDefaultTimeout(300000), prepare(page)) });

/** Opens an example and runs it for so many seconds. */
async function load(page, name, seconds = 0) {
  const scene = JSON.parse(readFileSync(join(root, "data", "scenes", `${name}.json`)));
  await commandFrom(page, "scene.load", { scene });
  await page.waitForFunction((title) => document.title.includes(title), scene.title);
  await page.waitForFunction(() => window.embody.loading() === 0, null, { timeout: 600000 });
  if (seconds > 0) await commandFrom(page, "simulation.step", { count: Math.round(60 * seconds) });
}

/** Puts PNG pictures side by side, in rows of `columns`, into a WebP file. */
async function write(page, name, pngs, columns = 1, clip = null) {
  const bytes = await page.evaluate(
    async ([pictures, columns, clip, quality]) => {
      const read = async (base64) => createImageBitmap(new Blob([Uint8Array.from(atob(base64), (each) => each.charCodeAt(0))]), ...(clip ? [clip.x, clip.y, clip.width, clip.height] : []));
      const all = await Promise.all(pictures.map(read));
      const gap = all.length > 1 ? 8 : 0;
      const [{ width, height }] = all;
      const canvas = new OffscreenCanvas(columns * (width + gap) - gap, Math.ceil(all.length / columns) * (height + gap) - gap);
      const pen = canvas.getContext("2d");
      pen.fillStyle = "#fff";
      pen.fillRect(0, 0, canvas.width, canvas.height);
      all.forEach((picture, at) => pen.drawImage(picture, (at % columns) * (width + gap), Math.floor(at / columns) * (height + gap)));
      return [...new Uint8Array(await (await canvas.convertToBlob({ type: "image/webp", quality })).arrayBuffer())];
    },
    [pngs.map((png) => png.toString("base64")), columns, clip, QUALITY],
  );
  writeFileSync(join(IMAGES, `${name}.webp`), Buffer.from(bytes));
  console.log(`${name}: ${bytes.length} bytes`);
}

/** The page as it is. */
async function shoot(page, name) {
  const file = join(scratch, `${name}.png`);
  await takePicture(page, file);
  return readFileSync(file);
}

const PICTURES = {
  async studio() {
    const page = await openPage();
    await load(page, "furnished_room");
    await page.getByTestId("search").fill("chair");
    await commandFrom(page, "simulation.step", { count: 50 });
    const user = new User(page);
    const at = await user.seen((await user.named("Chair 2")).index);
    await page.mouse.click(at.x, at.y);
    await page.waitForTimeout(1500);
    await write(page, "studio", [await shoot(page, "studio")]);
    return page;
  },
  async "soft-things"() {
    const shown = [["curtain_in_the_wind", 1], ["cushions_on_a_sofa", 1], ["rope_bridge", 1], ["bathtub", 1.2]];
    const pngs = [];
    let page;
    for (const [name, seconds] of shown) {
      await page?.context().close();
      page = await openPage({ width: 496, height: 316 + 72 });
      await load(page, name, seconds);
      pngs.push(await pictureOfScene(page));
    }
    await write(page, "soft-things", pngs, 2);
    return page;
  },
  async "guide-drag"() {
    const page = await openPage();
    await load(page, "furnished_room");
    await page.getByTestId("search").fill("armchair");
    await page.waitForTimeout(1500);
    const from = await page.getByTestId("model-tile").first().boundingBox();
    await page.mouse.move(from.x + 30, from.y + 30);
    await page.mouse.down();
    const to = await new User(page).project([-0.6, 0, 0.5]);
    await page.mouse.move(from.x + 60, from.y + 60, { steps: 3 });
    await page.mouse.move(to.x, to.y, { steps: 8 });
    await page.waitForFunction(() => window.embody.ghost() !== null);
    await page.waitForTimeout(1500);
    await write(page, "guide-drag", [await shoot(page, "guide-drag")]);
    await page.keyboard.press("Escape");
    await page.mouse.up();
    return page;
  },
  async "guide-room"() {
    const page = await openPage();
    await page.getByTestId("scene.new").click();
    const user = new User(page);
    await user.lookFrom([4.5, 5.5, 6.5], [0, 0, 0], [1]);
    await user.key("Shift+B");
    const [from, to] = [await user.project([-2.5, 0, -2]), await user.project([2.5, 0, 2])];
    await page.mouse.move(from.x, from.y);
    await page.mouse.down();
    await page.mouse.move(to.x, to.y, { steps: 6 });
    await page.waitForTimeout(800);
    await write(page, "guide-room", [await shoot(page, "guide-room")]);
    await page.mouse.up();
    return page;
  },
  async "guide-properties"() {
    const page = await openPage({ width: 1280, height: 900 });
    await load(page, "furnished_room");
    await new User(page).select([(await new User(page).named("Chair 2")).index]);
    await page.getByTestId("why-mass").click();
    await page.waitForTimeout(800);
    const box = await page.getByTestId("properties").boundingBox();
    await write(page, "guide-properties", [await shoot(page, "guide-properties")], 1, { x: Math.round(box.x), y: Math.round(box.y), width: Math.round(box.width), height: 620 });
    return page;
  },
  async "guide-time"() {
    const page = await openPage();
    await load(page, "dominoes", 4);
    await commandFrom(page, "time.seek", { time: 1.4 });
    await page.waitForFunction(() => window.embody.take().state.shown !== null);
    await page.waitForTimeout(1500);
    await write(page, "guide-time", [await shoot(page, "guide-time")]);
    return page;
  },
  async "guide-together"() {
    const page = await openPage();
    await load(page, "furnished_room");
    const other = await openPage({ quality: "low" });
    const [user, guest] = [new User(page), new User(other)];
    for (const [each, name] of [[page, "Ada"], [other, "Emmy"]]) {
      await each.getByTestId("name-input").fill(name);
      await each.getByTestId("name-input").press("Enter");
    }
    await guest.lookFrom([-2.2, 1.7, 2.9], [0.4, 0.6, 0], []).catch(() => {});
    await guest.select([(await guest.named("Table")).index]);
    const at = await guest.project([1.15, 0.78, 0.75]);
    await other.mouse.move(at.x, at.y, { steps: 4 });
    await user.focusScene();
    await page.waitForTimeout(2500);
    await write(page, "guide-together", [await shoot(page, "guide-together")]);
    await other.context().close();
    return page;
  },
  async vr() {
    // Both eyes at once: in full drawing a picture takes half a minute without a graphics card.
    const page = await openPage({ width: 1280, height: 640, quality: "low", prepare: (made) => wearHeadset(made) });
    await load(page, "furnished_room");
    const headset = new Headset(page);
    await headset.enter();
    await headset.look([0, 1.6, 0], [0, 1.1, -1.2]);
    await headset.press("left", "x-button");
    await headset.place("left", [-0.25, 1.25, -0.45]);
    await headset.aimInRoom("right", [0.3, 0.9, -2], [0.22, 1.2, -0.4]);
    await headset.frames(6);
    // What the left eye sees, without the empty space above and below.
    await write(page, "vr", [await headset.picture()], 1, { x: 0, y: 90, width: 636, height: 450 });
    return page;
  },
};

const wanted = process.argv.slice(2);
try {
  for (const [name, take] of Object.entries(PICTURES)) {
    if (wanted.length > 0 && !wanted.includes(name)) continue;
    const page = await take();
    if (page.faults.length > 0) console.error(`${name}: ${page.faults.join("; ")}`);
    await page.context().close();
  }
} finally {
  await browser.close();
  await server.discard();
}
