// SPDX-License-Identifier: MIT
// Makes the film "from empty room to a furnished one that is knocked over", in the Studio itself: with pointer and keys, as a user does.
//   node tests/studio/make_film.mjs [--quick] [--fast] [--from=CHAPTER] [FILE]      build/film/film.webm unless another file is named
// What is built is recorded in the page, what runs is filmed from its take, and the parts are joined. --quick only tries it, with few pictures.
// --fast draws without shadows; --from goes on with a chapter after one that failed.
import assert from "node:assert/strict";
import { mkdirSync, readFileSync, statSync, writeFileSync } from "node:fs";
import { dirname, join, resolve } from "node:path";
import { fileURLToPath } from "node:url";
import { openBrowser, openStudio } from "./browser.mjs";
import { joinFilms, pictureDifference, playFilm } from "./film_files.mjs";
import { findProgram, prepareDatabase, RealServer } from "./real_server.mjs";
import { commandFrom } from "./session.mjs";
import { User } from "./user.mjs";

const root = join(dirname(fileURLToPath(import.meta.url)), "..", "..");
const folder = join(root, "build", "film");
const words = process.argv.slice(2);
const isQuick = words.includes("--quick");
/** A chapter to begin with: what was made before it is still there. */
const from = words.find((word) => word.startsWith("--from="))?.slice(7) ?? null;
const file = resolve(words.find((word) => !word.startsWith("--")) ?? join(folder, "film.webm"));
const [WIDTH, HEIGHT] = [960, 540];
const SIZE = `${WIDTH}x${HEIGHT}`;
/** What is thrown is recorded at a quarter of real time, and shown four times as fast: enough pictures on a slow computer. */
const SLOW = 0.25;
const OVERVIEW = [[4.7, 3.5, 5.9], [-0.1, 0.75, -0.2]];

mkdirSync(folder, { recursive: true });
const program = findProgram();
if (!program) throw new Error("the program embody is not built: build it, or set EMBODY_PROGRAM");
const begun = performance.now();
const say = (text) => console.log(`${Math.round((performance.now() - begun) / 1000)} s: ${text}`);
const server = new RealServer(program, prepareDatabase(program));
const browser = await openBrowser();
const address = await server.start({ embody_scene: 1, title: "Film", entities: [] });
const page = await openStudio(browser, address, { width: 1500, height: 700, quality: isQuick || words.includes("--fast") ? "low" : "high", prepare: async (made) => made.setDefaultTimeout(120000) });
const user = new User(page, { hurries: isQuick });
const command = (name, params = {}) => commandFrom(page, name, params);

/** The film's parts so far, and a file for the next. */
let parts = [];
const part = (name) => join(folder, `${name}.webm`);
/** Records what `work` does, under a title. */
async function recorded(title, name, work) {
  say(title);
  const path = part(name);
  await user.record(title);
  await work();
  await user.hold(1);
  await user.endRecording(path);
  parts.push({ path });
}
/** Films a part of the run. */
async function filmed(text, name, plan) {
  say(text);
  const path = part(name);
  await user.film(path, { size: SIZE, text, ...plan, ...(isQuick && { rate: 2 }) });
  parts.push({ path });
}

/** Things that stay: a drag from them turns the camera. */
const fixed = async () => {
  const { scene } = await command("hello");
  return scene.entities.filter(({ locked, shape }) => locked || shape?.type === "plane" || shape?.type === "wall" || shape?.type === "slab").map(({ index }) => index);
};
const look = async (position, target, options) => user.lookFrom(position, target, await fixed(), options);
const CATALOGUE = "sweethome3d:";

/** The picture has exactly the film's size. */
async function fitPage() {
  // The panels grow with the page.
  for (let times = 0; times < 8; ++times) {
    const canvas = await user.canvas();
    const [width, height] = [WIDTH - Math.round(canvas.width), HEIGHT - Math.round(canvas.height)];
    if (width === 0 && height === 0) return;
    const now = page.viewportSize();
    await page.setViewportSize({ width: now.width + width, height: now.height + height });
    await page.waitForTimeout(600);
  }
}

// Building ---------------------------------------------------------------------------------------------------------------

async function emptyRoom() {
  await user.hold(1);
  await look([5.4, 5.2, 7.4], [0, 0, 0]);
  await user.hold(1);
  await user.key("Shift+b");
  await user.drag(await user.project([-3, 0, -2.2]), await user.project([3, 0, 2.2]), { steps: 40 });
  await user.hold(1);
  await user.key("Escape");
  // Without the two walls in front one looks in.
  for (const point of [[0.5, 1.4, 2.2], [3, 1.4, 0.3]]) {
    await user.click(await user.project(point), { modifier: "Alt" });
    await user.hold(1);
    await user.key("l");
    await user.key("Delete");
  }
  await look(...OVERVIEW, { steps: 40 });
  const floor = await user.named("Room floor").catch(() => user.named("Floor"));
  await user.select([floor.index]);
  await page.getByTestId("look-fields").getByLabel("Finish").selectOption("parquet");
  await user.hold(1);
  await user.key("Escape");
}

async function doorAndWindows() {
  await user.key("b");
  await page.getByTestId("build-bar").getByTestId("build.door").click();
  await user.click(await user.project([-2.94, 1, 1.3]));
  await user.hold(1);
  await page.getByTestId("build-bar").getByTestId("build.window").click();
  await user.click(await user.project([-1.2, 1.55, -2.14]));
  await user.hold(1);
  await user.key("Escape");
  await user.key("Escape");
  await user.key("Escape");
  // One of the library opens the wall by itself.
  await user.place("double window", `${CATALOGUE}Scopia#window_2x1_medium_with_large_pane`, [0.5, 1.5, -2.14]);
  await user.key("Escape");
  const sky = page.getByTestId("scene-fields").getByLabel("Sky");
  await sky.check();
  await user.hold(1);
  await letTimePass(7, 10);
  await user.hold(1);
}

/** Of the day, by the slider of the scene. */
async function letTimePass(from, to) {
  const slider = page.getByTestId("time-of-day");
  for (let hour = from; hour <= to; hour += 0.25) {
    await slider.fill(String(hour));
    await page.waitForTimeout(120);
  }
}

/** Words to find it by, key, place, and turns by 15°. */
const FURNITURE = [
  ["oriental rug", "Kator Legaz#oriental-rug", [-1, 0.01, -0.2], 6],
  ["lamp", "Scopia#living_lamp", [-2.55, 0.01, -1.75]],
  ["plant", "Blend Swap CC-0#plant", [0.5, 0.01, -1.7]],
  ["full bookcase", "Kator Legaz#full-bookcase", [1.6, 0.01, -1.95]],
  ["shelves", "Kator Legaz#utility-shelving", [2.6, 0.01, -1.95]],
  ["sofa", "Scopia#leather_sofa", [-1, 0.01, -1.6]],
  ["armchair", "Scopia#armchair", [-2.35, 0.01, -0.3], 4],
  ["living table", "Scopia#living_room_table", [-1, 0.01, -0.35]],
  ["cafe chair", "Kator Legaz#cafe-chair", [1.2, 0.01, -0.55]],
  ["cafe chair", "Kator Legaz#cafe-chair", [1.95, 0.01, -0.55]],
  ["alder table", "Scopia#wooden_office_alder_table", [1.55, 0.01, 0.15]],
  ["cafe chair", "Kator Legaz#cafe-chair", [1.2, 0.01, 0.85], 12],
  ["cafe chair", "Kator Legaz#cafe-chair", [1.95, 0.01, 0.85], 12],
];
const SMALL = [
  ["vase", "Scopia#vase1", [1.55, 0.76, 0.1]],
  ["fruits", "Scopia#bowlWithFruits", [1.1, 0.76, 0.2]],
  ["wine bottle", "Scopia#wine_bottle", [1.85, 0.76, 0.0]],
  ["mug", "Kator Legaz#coffee-mug", [2.0, 0.76, 0.3]],
  ["vase", "Scopia#vase2", [2.6, 1.2, -1.95]],
  ["book", "Blend Swap CC-BY#book", [-1.3, 0.54, -0.3]],
  ["teddy", "Blend Swap CC-0#teddyBear", [-1.6, 0.5, -1.5]],
];

async function placeAll(list) {
  for (const [words, key, point, turns = 0] of list) {
    const made = await user.place(words, CATALOGUE + key, point, { turns });
    const [x, y, z] = made.position;
    const away = Math.hypot(x - point[0], z - point[2]);
    if (away > 0.25) console.warn(`  ${made.name} stands ${away.toFixed(2)} m from where it was dropped, at ${[x, y, z].map((each) => each.toFixed(2))}`);
    await user.hold(1);
  }
  await user.key("Escape");
}

/** Typed sizes of a box, m. */
async function resize(width, height, depth) {
  for (const [label, value] of [["Width", width], ["Height", height], ["Depth", depth]]) await user.type(label, value);
}

async function paint(color) {
  const field = page.getByTestId("properties").getByLabel("Colour", { exact: true });
  await field.evaluate((each, color) => {
    each.value = color;
    each.dispatchEvent(new Event("change"));
  }, color);
  await page.waitForTimeout(300);
}

async function softThings() {
  await user.primitive("cloth", [1.55, 0.76, 0.15], { name: "Tablecloth" });
  await paint("#b33a3a");
  await user.hold(1);
  for (const [x, color] of [[-0.45, "#d9822b"], [-1.05, "#2f7f6f"]]) {
    await user.primitive("cushion", [x, 0.5, -1.5], { name: "Cushion" });
    await paint(color);
    await user.hold(1);
  }
}

async function dominoes() {
  await look([2.2, 2.0, 4.9], [0.1, 0.2, 1.2]);
  await user.primitive("box", [-1.6, 0.01, 1.55], { name: "Domino" });
  await resize(0.05, 0.3, 0.16);
  await paint("#e0b84c");
  await user.key("End");
  await user.key("Control+Shift+D");
  await page.getByLabel("Copies along x", { exact: true }).fill("24");
  await page.getByLabel("Copies along x", { exact: true }).press("Enter");
  await page.getByLabel("Distance along x", { exact: true }).fill("0.14");
  await page.getByLabel("Distance along x", { exact: true }).press("Enter");
  await user.hold(2);
  await page.getByTestId("array-make").click();
  await page.waitForFunction(() => window.embody.entities().filter(({ name }) => name.startsWith("Domino")).length === 24);
  await user.hold(1);
  await user.place("vase", `${CATALOGUE}Scopia#vase3`, [-1.95, 0.01, 1.55]);
  await user.hold(1);
  await user.place("basketball", `${CATALOGUE}Blend Swap CC-0#basketball`, [2.3, 0.01, 1.55], { name: "Basketball" });
  await user.hold(1);
  await user.key("Escape");
  await look(...OVERVIEW, { steps: 30 });
  await user.hold(1);
}

async function evening() {
  await user.key("Escape");
  await letTimePass(15, 20.5);
  await user.hold(1);
  const { scene } = await command("hello");
  await user.select([scene.entities.find(({ model }) => model?.endsWith("#living_lamp")).index]);
  await page.getByTestId("look-fields").getByLabel("Light").check();
  await user.hold(2);
  await user.key("Escape");
  await look([1.2, 1.5, 2.2], [-1.2, 0.6, -1]);
  await user.hold(3);
  await letTimePass(7, 11);
  await look(...OVERVIEW);
}

// Playing ----------------------------------------------------------------------------------------------------------------

const now = () => page.evaluate(() => window.embody.take().state.end);

/** Lets so many simulated seconds pass. */
async function pass(seconds) {
  const end = (await now()) + seconds;
  await page.waitForFunction((end) => window.embody.take().state.end >= end, end, { timeout: 600000 });
}

async function playFor(seconds) {
  await user.key("Space");
  await pass(seconds);
  await user.key("Space");
  await page.waitForFunction(() => window.embody.simulation().state === "paused");
}

/** Takes hold of a thing, or of a point of the world, while the scene plays slowly, pulls it to others, s of simulated time each, and lets go. What is held moves in the picture's plane. */
async function pull(from, ways) {
  const grip = Array.isArray(from) ? await user.project(from) : await user.seen(from.index);
  await user.glide(grip, { steps: 8 });
  await page.mouse.down();
  for (const { to, seconds } of ways) {
    const [start, end] = [user.at, await user.project(to)];
    const begin = await now();
    for (let part = 0; part < 1; ) {
      part = Math.min(1, ((await now()) - begin) / seconds);
      await page.mouse.move(start.x + part * (end.x - start.x), start.y + part * (end.y - start.y));
    }
    user.at = end;
  }
  await page.mouse.up();
}

/** Plays slowly, records what the hand does, and shows it in real time; returns from when to when it was. */
async function acted(title, name, act, seconds) {
  say(title);
  await page.getByTestId("time-rate").selectOption(String(SLOW));
  const from = await now();
  const path = part(name);
  await user.key("Space");
  await user.record(title, { isSmooth: false, tells: false });
  await act();
  await pass(seconds);
  await user.endRecording(path);
  await user.key("Space");
  parts.push({ path, speed: 1 / SLOW });
  await page.getByTestId("time-rate").selectOption("1");
  return { from, to: await now() };
}

async function addJump() {
  await page.getByTestId("properties").getByTestId("action-fields").locator("summary").click();
  await page.getByTestId("add-action").click();
  await page.getByTestId("effect").selectOption("set_velocity");
  await page.getByTestId("action-dialog").getByLabel("Velocity y").fill("3.2");
  await page.getByTestId("action-dialog").getByLabel("Velocity y").press("Enter");
  await page.getByTestId("action-save").click();
}

// The film ---------------------------------------------------------------------------------------------------------------

const CHAPTERS = {
  room: () => recorded("From an empty room …", "room", emptyRoom),
  windows: () => recorded("A door, windows, daylight", "windows", doorAndWindows),
  furniture: () => recorded("Furniture from the library", "furniture", () => placeAll(FURNITURE)),
  soft: () => recorded("Soft things", "soft", softThings),
  things: () => recorded("Things on things", "things", () => placeAll(SMALL)),
  dominoes: () => recorded("Dominoes in a row", "dominoes", dominoes),
  evening: () => recorded("Evening", "evening", evening),
  async play() {
    await addJump();
    await user.key("Escape");
    await playFor(4);
    await filmed("Play: everything is what it is made of", "play", { from: 0, to: 4 });
    await look([3.3, 1.7, 2.4], [1.5, 0.75, 0.2]);
    await filmed("A cloth falls over its table (½ speed)", "cloth", { from: 0, to: 2, rate: 0.5 });

    // From in front, so that the way along the dominoes lies in the picture's plane.
    await look([0.6, 1.3, 5.4], [0.6, 0.2, 1.5]);
    const ball = await user.named("Basketball");
    const throwBall = () => pull(ball.position, [{ to: [ball.position[0] - 0.9, ball.position[1] + 0.05, ball.position[2]], seconds: 0.35 }]);
    const thrown = await acted("A throw", "throw", throwBall, 3.5);
    await look([-1.4, 1.0, 3.9], [0.1, 0.15, 1.4]);
    await filmed("Again, at ¼ speed", "domino-run", { from: thrown.from + 0.4, to: Math.min(thrown.to, thrown.from + 3.4), rate: 0.25 });

    await look([1.9, 1.7, 3.4], [1.7, 0.7, 0.3]);
    const cloth = await user.named("Tablecloth");
    const swept = await acted("The tablecloth …", "sweep", () => pull(cloth, [{ to: [3.4, 0.85, 0.3], seconds: 0.5 }]), 2.5);
    await filmed("… at ¼ speed", "sweep-slow", { from: swept.from + 0.3, to: Math.min(swept.to, swept.from + 3), rate: 0.25 });

    await look([4.9, 2.6, -0.3], [1.6, 1.1, -0.8]);
    const toppled = await acted("The bookcase", "bookcase", () => pull([1.8, 2.16, -1.9], [{ to: [1.8, 2.0, -0.2], seconds: 0.9 }]), 2.5);
    await look([3.9, 1.9, 2.9], [1.4, 0.8, -0.4]);
    await filmed("… at ¼ speed", "bookcase-slow", { from: toppled.from + 0.4, to: Math.min(toppled.to, toppled.from + 3.4), rate: 0.25 });

    // From the start again, so that nothing lies on the cloth.
    await user.key("Home");
    await playFor(2);
    await look(...OVERVIEW);
    const jumped = await acted("An action: K lets everything jump", "jump", () => user.key("k"), 2.5);
    await filmed("… at ¼ speed", "jump-slow", { from: jumped.from, to: Math.min(jumped.to, jumped.from + 2.2), rate: 0.25 });

    await user.key("Escape");
    await page.getByTestId("place-Moon").click();
    const moon = await acted("The same on the Moon", "moon", () => user.key("k"), 5);
    await look([5.6, 2.2, 5.2], [-0.1, 1.0, -0.2]);
    await filmed("… seen from the side", "moon-side", { from: moon.from, to: moon.to });

    await user.key("Home");
    await recorded("Home: all is as it was", "end", async () => {
      await look(...OVERVIEW, { steps: 60 });
      await user.hold(3);
    });
  },
};

try {
  await fitPage();
  await user.key("t");
  await page.getByTestId("scene.new").click();
  await page.waitForTimeout(1500);
  let isBegun = from === null;
  for (const [name, work] of Object.entries(CHAPTERS)) {
    if (!isBegun && name === from) {
      const { scene, parts: made } = JSON.parse(readFileSync(join(folder, `before-${name}.json`), "utf8"));
      parts = made;
      await command("scene.load", { scene });
      await page.waitForFunction((title) => document.title.includes(title), scene.title);
      await page.waitForFunction(() => window.embody.loading() === 0, null, { timeout: 120000 });
      await page.waitForTimeout(1500);
      isBegun = true;
    }
    if (!isBegun) continue;
    const { scene } = await command("hello");
    writeFileSync(join(folder, `before-${name}.json`), JSON.stringify({ scene, parts }));
    await work();
  }

  const length = await joinFilms(parts, file);
  say(`joined: ${length.toFixed(1)} s`);
  const stills = Array.from({ length: 60 }, (_, at) => ((at + 0.5) * length) / 60);
  const film = await playFilm(browser, file, stills, folder, 1.1);
  const { size } = statSync(file);
  assert.deepEqual([film.width, film.height], [WIDTH, HEIGHT]);
  assert.ok(Math.abs(film.duration - length) < 1, `a browser plays ${film.duration} s`);
  for (const still of film.pictures) assert.ok(still.light > 10, `the picture at ${still.time} s is dark`);
  const steps = film.pictures.slice(1).map((still, at) => pictureDifference(still, film.pictures[at]));
  assert.ok(steps.filter((step) => step > 0.2).length > 0.8 * steps.length, `pictures differ: ${steps.map((step) => step.toFixed(1))}`);
  if (!isQuick) assert.ok(length > 240 && length < 360, `about five minutes: ${length} s`);
  assert.deepEqual(page.faults, []);
  say(`${file}: ${film.width} × ${film.height}, ${film.duration.toFixed(1)} s, ${(size / 1e6).toFixed(1)} MB`);
} catch (error) {
  // What the page showed then.
  await page.screenshot({ path: join(folder, "failed.png") }).catch(() => {});
  throw error;
} finally {
  await browser.close();
  await server.discard();
}
