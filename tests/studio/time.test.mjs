// SPDX-License-Identifier: MIT
// The line of time: a run is recorded, looked back on, gone on with, slowed down, plotted, filmed and pictured.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { after, before, beforeEach, describe, it } from "node:test";
import { atRest, openStudio, takePicture } from "./browser.mjs";
import { pictureDifference, playFilm } from "./film_files.mjs";
import { Session } from "./session.mjs";

const SCENE = {
  embody_scene: 1,
  title: "Fall",
  entities: [
    { index: 1, name: "Floor", shape: { type: "box", half_extents: [6, 0.25, 6] }, attributes: { kind: "static" }, pose: { position: [0, -0.25, 0] }, color: [0.4, 0.42, 0.45] },
    { index: 2, name: "Ball", shape: { type: "sphere", radius: 0.3 }, pose: { position: [0, 3, 0] }, color: [0.9, 0.3, 0.1] },
    { index: 3, name: "Crate", shape: { type: "box", half_extents: [0.3, 0.3, 0.3] }, pose: { position: [1.5, 1.5, 0] }, color: [0.2, 0.5, 0.9] },
  ],
  actions: [{ name: "Push", trigger: { type: "time", time: 0.5 }, effect: { type: "apply_impulse", impulse: [60, 0, 0] }, receiver: { index: 3 } }],
  camera: { position: [4, 2.5, 6], target: [0.5, 1, 0] },
};
const G = 9.81;

describe("the line of time", { timeout: 900000 }, () => {
  const session = new Session();
  let page;

  before(() => session.start(SCENE));
  after(() => session.end());
  beforeEach(async () => {
    page = await session.reopen({ height: 720 });
    await session.command("scene.load", { scene: SCENE });
    await page.waitForFunction(() => window.embody.entities().filter(({ drawn }) => drawn).length === 3 && window.embody.take().state.samples === 0);
  });

  const picture = (name) => process.env.EMBODY_TEST_PICTURES && takePicture(page, `${process.env.EMBODY_TEST_PICTURES}/${name}.png`);
  const take = (at = page) => at.evaluate(() => window.embody.take());
  /** How high the thing is at the end of what has run, as the server says. */
  const heightAtEnd = async (index) => (await session.command("time.curves", { curves: [{ index, quantity: "height" }] })).curves[0].values.at(-1);
  /** Runs so many steps. */
  async function run(steps) {
    await session.command("simulation.step", { count: steps });
    await page.waitForFunction((end) => Math.abs(window.embody.take().state.end - end) < 1e-6, steps / 60);
  }
  const shows = (time, at = page) => at.waitForFunction((time) => Math.abs((window.embody.take().state.shown ?? -1) - time) < 1e-6, time);
  /** Waits until the thing is drawn at this height, for frames come after replies. */
  const drawnAt = (index, wanted, at = page) => at.waitForFunction(([index, wanted]) => Math.abs(window.embody.entities().find((each) => each.index === index).position[1] - wanted) < 0.03, [index, wanted]);

  it("appears with the first run, with marks of contacts and actions", async () => {
    assert.equal(await page.getByTestId("timeline").isVisible(), false);
    await run(90);
    await page.getByTestId("timeline").waitFor();
    await page.waitForFunction(() => ["contact", "action"].every((kind) => window.embody.take().marks.some((mark) => mark.kind === kind)));
    const { marks } = await take();
    const first = marks.find((mark) => mark.kind === "contact" && [mark.a, mark.b].includes(2));
    assert.ok(Math.abs(first.time - Math.sqrt((2 * 2.7) / G)) < 2 / 60, `the ball lands at ${first.time}`);
    const action = marks.find(({ kind }) => kind === "action");
    assert.equal(action.name, "Push");
    assert.ok(Math.abs(action.time - 0.5) < 2 / 60);
    // Their tips say what they are.
    const track = await page.getByTestId("time-track").boundingBox();
    const end = Math.max(1.5, 2);
    await page.mouse.move(track.x + (action.time / end) * track.width, track.y + 30);
    await page.waitForFunction(() => document.querySelector('[data-testid="time-tip"]').textContent.includes("Action “Push”"));
    await picture("timeline");
    await session.command("simulation.reset");
    await page.getByTestId("timeline").waitFor({ state: "hidden" });
  });

  it("scrubs by mouse and keys, for everybody", async () => {
    await run(60);
    const other = await openStudio(session.browser, session.address);
    const now = await heightAtEnd(2);
    await drawnAt(2, now);
    const track = await page.getByTestId("time-track").boundingBox();
    // The line shows two seconds: its quarter is half a second.
    await page.mouse.click(track.x + track.width / 4, track.y + 30);
    await page.waitForFunction(() => Math.abs((window.embody.take().state.shown ?? 9) - 0.5) < 0.02);
    const { shown } = (await take()).state;
    for (const at of [page, other]) {
      await shows(shown, at);
      await drawnAt(2, 3 - (G * shown * shown) / 2, at);
    }
    assert.ok(await other.getByTestId("time-badge").isVisible(), "the other page says that it looks back");
    await page.getByTestId("time-track").press("ArrowLeft");
    await page.waitForFunction((before) => window.embody.take().state.shown < before, shown);
    await shows((await take()).state.shown, other);
    await page.getByTestId("time-track").press("Home");
    await shows(0);
    await drawnAt(2, 3);
    await page.getByTestId("time-track").press("End");
    await page.waitForFunction(() => window.embody.take().state.shown === null);
    await drawnAt(2, now);
    await other.context().close();
  });

  it("goes on anew from a moment, and keeps one", async () => {
    await run(80);
    await session.command("time.seek", { time: 0.5 });
    await shows(0.5);
    await page.getByTestId("time.branch").click();
    await page.waitForFunction(() => window.embody.take().state.shown === null && Math.abs(window.embody.take().state.end - 0.5) < 1e-6);
    await session.command("simulation.step", { count: 12 });
    await drawnAt(2, 3 - (G * 0.49) / 2);
    await session.command("time.seek", { time: 0.3 });
    await shows(0.3);
    await page.getByTestId("time.keep").click();
    await page.getByTestId("timeline").waitFor({ state: "hidden" });
    const { scene } = await session.command("hello");
    const kept = scene.entities.find(({ index }) => index === 2).pose.position[1];
    assert.ok(Math.abs(kept - (3 - (G * 0.09) / 2)) < 0.03, `kept at ${kept}`);
    await page.getByTestId("edit.undo").click();
    await drawnAt(2, 3);
  });

  it("runs slower by the speed that is chosen", async () => {
    await run(2);
    await page.getByTestId("time-rate").selectOption("0.1");
    await page.waitForFunction(() => window.embody.simulation().rate === 0.1);
    await session.command("simulation.play");
    // As the server measures it while it plays.
    await page.waitForFunction(() => {
      const factor = window.embody.statistics()?.real_time_factor ?? 0;
      return window.embody.simulation().time > 0.1 && factor > 0 && factor < 0.15;
    });
    await session.command("simulation.pause");
    await page.getByTestId("time-rate").selectOption("1");
    await page.waitForFunction(() => window.embody.simulation().rate === 1);
  });

  it("plots what the server has recorded, and saves it as a table", async () => {
    await run(60);
    await page.getByTestId("time.plots").click();
    await page.getByTestId("tab-In the scene").click();
    await page.evaluate(() => document.querySelector('[data-testid="canvas"]').focus());
    await page.keyboard.press("Control+a");
    await page.waitForFunction(() => window.embody.plotted().curves.length === 3);
    const plotted = await page.evaluate(() => window.embody.plotted());
    const told = await session.command("time.curves", { curves: [{ index: 2, quantity: "height" }], samples: 800 });
    assert.deepEqual(plotted.times, told.times);
    assert.deepEqual(plotted.curves.find(({ index }) => index === 2).values, told.curves[0].values);
    for (const [at, time] of told.times.entries()) if (time < 0.7) assert.ok(Math.abs(told.curves[0].values[at] - (3 - (G * time * time) / 2)) < 0.01);
    await page.getByTestId("plot-quantity").selectOption("speed");
    await page.waitForFunction(() => window.embody.plotted().curves[0]?.quantity === "speed");
    await picture("plots");
    const [file] = await Promise.all([page.waitForEvent("download"), page.getByTestId("plot-csv").click()]);
    const lines = readFileSync(await file.path(), "utf8").trim().split("\r\n");
    assert.equal(lines.length, 62);
    assert.equal(lines[0], '"Time (s)","Floor speed (m/s)","Ball speed (m/s)","Crate speed (m/s)"');
    assert.ok(Math.abs(Number(lines[31].split(",")[2]) - G * Number(lines[31].split(",")[0])) < 0.05, lines[31]);
    await page.getByTestId("time.plots").click();
  });

  it("makes a film that a browser plays", async () => {
    await run(60);
    await page.getByTestId("time.film").click();
    await page.getByTestId("film-size").selectOption("640x360");
    await page.getByTestId("film-rate").selectOption("0.5");
    await page.getByTestId("film-fps").selectOption("24");
    await page.getByTestId("film-text").fill("A fall");
    await picture("film");
    const [file] = await Promise.all([page.waitForEvent("download", { timeout: 240000 }), page.getByTestId("film-start").click()]);
    assert.equal(file.suggestedFilename(), "Fall.webm");
    const film = await playFilm(session.browser, await file.path(), [0, 1, 1.9]);
    assert.deepEqual([film.width, film.height], [640, 360]);
    // A second of the run at half speed, and the length of the last picture.
    assert.ok(Math.abs(film.duration - 2) < 0.1, `${film.duration} s`);
    for (const { light, red } of film.pictures) assert.ok(light > 15 && red > 50, JSON.stringify(film.pictures));
    assert.ok(film.pictures[1].row > film.pictures[0].row + 20, `the ball falls: ${JSON.stringify(film.pictures)}`);
    // The page shows again what everybody sees.
    const now = await session.command("time.curves", { curves: [{ index: 2, quantity: "height" }], from: 0.99 });
    await drawnAt(2, now.curves[0].values.at(-1));
    assert.equal(await page.evaluate(() => window.embody.take().state.shown), null);
  });

  it("records what the user does: picture, pointer, and what was done", async () => {
    await page.evaluate(() => document.querySelector('[data-testid="canvas"]').focus());
    await page.keyboard.press("Control+k");
    await page.keyboard.type("record what");
    await page.keyboard.press("Enter");
    await page.getByTestId("record-pace").selectOption("smooth");
    await page.getByTestId("record-text").fill("How it was built");
    await page.getByTestId("record-start").click();
    await page.getByTestId("recording").waitFor();
    const begun = Date.now();
    const canvas = await page.getByTestId("canvas").boundingBox();
    const [from, to] = [await page.getByTestId("primitive-sphere").boundingBox(), { x: canvas.x + 0.3 * canvas.width, y: canvas.y + 0.7 * canvas.height }];
    // A pause is what the hand waits after the last picture.
    await atRest(page);
    await page.waitForTimeout(1500);
    await page.mouse.move(from.x + 10, from.y + 10);
    await page.mouse.down();
    for (let part = 0.1; part < 1.01; part += 0.1) {
      await page.mouse.move(from.x + part * (to.x - from.x), from.y + part * (to.y - from.y));
      await page.waitForTimeout(100);
    }
    await page.mouse.up();
    await page.waitForFunction(() => window.embody.entities().length === 4);
    await picture("recording");
    await atRest(page);
    await page.waitForTimeout(2500);
    let took = 0;
    const end = page.getByTestId("recording-end").click().then(() => (took = (Date.now() - begun) / 1000));
    const [file] = await Promise.all([page.waitForEvent("download", { timeout: 240000 }), end]);
    assert.equal(file.suggestedFilename(), "Fall.webm");
    await page.getByTestId("recording").waitFor({ state: "hidden" });
    const { duration, width, height } = await playFilm(session.browser, await file.path(), []);
    assert.ok(Math.abs(width / height - canvas.width / canvas.height) < 0.02, `${width} × ${height}`);
    // Of both pauses a second is left; a slow machine works longer, so that the film is measured by that.
    assert.ok(duration > 2 && duration < took - 1.9, `${duration} s of ${took} s`);
    const film = await playFilm(session.browser, await file.path(), [0, duration - 0.1], process.env.EMBODY_TEST_PICTURES ?? null, 1.1);
    const [first, last] = film.pictures;
    assert.ok(first.light > 15 && last.light > 15, "the scene is in the picture");
    const difference = pictureDifference(first, last);
    assert.ok(difference > 0.3, `the ball was brought in: ${difference} between the first picture and that at ${last.time} of ${duration} s`);
    assert.deepEqual(page.faults, []);
  });

  it("saves the run as a glTF animation that loads elsewhere", async () => {
    await run(60);
    await page.getByTestId("time.film").click();
    const [file] = await Promise.all([page.waitForEvent("download", { timeout: 240000 }), page.getByTestId("film-gltf").click()]);
    assert.equal(file.suggestedFilename(), "Fall.glb");
    const bytes = readFileSync(await file.path());
    // Read as the specification says: header, JSON, binary chunk.
    assert.deepEqual([bytes.toString("latin1", 0, 4), bytes.readUInt32LE(4), bytes.readUInt32LE(8)], ["glTF", 2, bytes.length]);
    const length = bytes.readUInt32LE(12);
    const gltf = JSON.parse(bytes.toString("utf8", 20, 20 + length));
    assert.equal(gltf.animations.length, 1);
    assert.deepEqual(gltf.extensionsRequired ?? [], []);
    // The same by the loader of three.js, on a page of its own.
    const { GLTFLoader } = await import("../../studio/node_modules/three/examples/jsm/loaders/GLTFLoader.js");
    const { AnimationMixer, Vector3 } = await import("../../studio/node_modules/three/build/three.module.js");
    const loaded = await new GLTFLoader().parseAsync(bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.length), "");
    const [clip] = loaded.animations;
    assert.ok(Math.abs(clip.duration - 1) < 1e-6, `${clip.duration} s`);
    assert.equal(clip.tracks.length, 4, "two things move: places and rotations");
    const mixer = new AnimationMixer(loaded.scene);
    mixer.clipAction(clip).play();
    const place = (name) => loaded.scene.getObjectByName(name).getWorldPosition(new Vector3());
    for (const [time, index] of [[0.5, 2], [0.999, 2], [0.999, 3]]) {
      mixer.setTime(time);
      const told = await session.command("time.curves", { curves: [{ index, quantity: "height" }], from: time - 0.02, to: time + 0.02 });
      const name = index === 2 ? "Ball_2" : "Crate_3";
      const near = told.times.reduce((best, each, at) => (Math.abs(each - time) < Math.abs(told.times[best] - time) ? at : best), 0);
      assert.ok(Math.abs(place(name).y - told.curves[0].values[near]) < 0.1, `${name} at ${time}: ${place(name).y}, ${told.curves[0].values[near]}`);
    }
    assert.ok(Math.abs(place("Floor_1").y + 0.25) < 1e-6);
  });

  it("stops a film that is cancelled, and says what is wrong with its times", async () => {
    await run(60);
    await page.getByTestId("time.film").click();
    await page.getByTestId("film-to").fill("99");
    assert.equal(await page.getByTestId("film-start").isDisabled(), true);
    assert.match(await page.getByTestId("film-note").textContent(), /Recorded is/);
    await page.getByTestId("film-to").fill("1");
    // So long that it is not done before it is cancelled.
    await page.getByTestId("film-rate").selectOption("0.1");
    await page.getByTestId("film-fps").selectOption("60");
    await page.getByTestId("film-start").click();
    await page.waitForFunction(() => /Picture \d+/.test(document.querySelector('[data-testid="film-note"]')?.textContent ?? ""), null, { timeout: 60000 });
    await page.getByTestId("film-cancel").click();
    const frames = await page.evaluate(() => window.embody.frames());
    await session.command("simulation.step", { count: 5 });
    await page.waitForFunction((frames) => window.embody.frames() > frames, frames, { timeout: 60000 });
    const now = await session.command("time.curves", { curves: [{ index: 2, quantity: "height" }], from: 1.08 });
    await drawnAt(2, now.curves[0].values.at(-1));
  });

  it("draws pictures of any size, also transparent", async () => {
    const save = async (width, height, isTransparent) => {
      await page.evaluate(() => document.querySelector('[data-testid="canvas"]').focus());
      await page.keyboard.press("Control+k");
      await page.keyboard.type("picture of any size");
      await page.keyboard.press("Enter");
      await page.getByTestId("picture-width").fill(String(width));
      await page.getByTestId("picture-height").fill(String(height));
      if (isTransparent) await page.getByTestId("picture-transparent").check();
      const [file] = await Promise.all([page.waitForEvent("download", { timeout: 240000 }), page.getByTestId("picture-save").click()]);
      return readFileSync(await file.path());
    };
    const large = await save(3840, 2160, false);
    assert.deepEqual([large.readUInt32BE(16), large.readUInt32BE(20)], [3840, 2160]);
    const clear = await save(640, 360, true);
    const seen = await page.evaluate(
      async ([large, clear]) => {
        const read = async (base64) => {
          const bytes = Uint8Array.from(atob(base64), (character) => character.charCodeAt(0));
          const bitmap = await createImageBitmap(new Blob([bytes], { type: "image/png" }));
          const canvas = new OffscreenCanvas(bitmap.width, bitmap.height);
          canvas.getContext("2d").drawImage(bitmap, 0, 0);
          return (x, y) => [...canvas.getContext("2d").getImageData(Math.round(x * bitmap.width), Math.round(y * bitmap.height), 1, 1).data];
        };
        const [one, other] = [await read(large), await read(clear)];
        const places = [[0.05, 0.05], [0.5, 0.9], [0.62, 0.6]];
        return { large: places.map(([x, y]) => one(x, y)), clear: places.map(([x, y]) => other(x, y)) };
      },
      [large.toString("base64"), clear.toString("base64")],
    );
    assert.equal(seen.clear[0][3], 0, "nothing is behind the scene");
    assert.equal(seen.clear[1][3], 255, "the floor is solid");
    // Both sizes show the same.
    for (const channel of [0, 1, 2]) assert.ok(Math.abs(seen.large[1][channel] - seen.clear[1][channel]) < 12, JSON.stringify(seen));
  });
});
