// SPDX-License-Identifier: MIT
// A user of the Studio: pointer and keys, with pictures drawn between two movements of the hand.
import { Vector3, Spherical } from "../../studio/node_modules/three/build/three.module.js";

/** A movement of the hand has so many steps, unless it says otherwise. */
const STEPS = 18;
/** Longest wait for a picture after a step, ms: nothing may have changed. */
const PICTURE_MS = 700;
/** As CameraRig turns and zooms, and so many turns, notches and pixels are tried until the camera is there. */
const ORBIT_PER_PIXEL = 0.006;
const ZOOM_PER_NOTCH = 1.12;

export class User {
  at = { x: 640, y: 400 };

  /** Who is in a hurry makes few steps and no pauses. */
  constructor(page, { hurries = false } = {}) {
    this.page = page;
    this.hurries = hurries;
  }

  entities() {
    return this.page.evaluate(() => window.embody.entities());
  }

  async entity(index) {
    return (await this.entities()).find((each) => each.index === index);
  }

  /** The newest entity of this name. */
  async named(name) {
    const found = (await this.entities()).filter((each) => each.name === name).at(-1);
    if (!found) throw new Error(`nothing is called ${name}`);
    return found;
  }

  /** Where a point of the world is on the page. */
  project(point) {
    return this.page.evaluate(([x, y, z]) => window.embody.project(x, y, z), point);
  }

  seen(index) {
    return this.page.evaluate((index) => window.embody.seenAt(index), index);
  }

  canvas() {
    return this.page.getByTestId("canvas").boundingBox();
  }

  /** A step of the hand; waits for the picture that it makes. */
  async step(x, y) {
    const frames = await this.page.evaluate(() => window.embody.frames());
    await this.page.mouse.move(x, y);
    this.at = { x, y };
    await this.page.waitForFunction((frames) => window.embody.frames() > frames, frames, { timeout: PICTURE_MS, polling: 10 }).catch(() => {});
  }

  /** Moves the hand to a point of the page, slower at both ends; `draws`: each step changes the picture. */
  async glide(to, { steps = STEPS, draws = false } = {}) {
    const from = this.at;
    if (this.hurries) steps = Math.min(steps, 4);
    for (let at = 1; at <= steps; ++at) {
      const part = at / steps;
      const eased = part * part * (3 - 2 * part);
      const [x, y] = [from.x + eased * (to.x - from.x), from.y + eased * (to.y - from.y)];
      if (draws) await this.step(x, y);
      else {
        await this.page.mouse.move(x, y);
        this.at = { x, y };
        await this.page.waitForTimeout(45);
      }
    }
  }

  /** Clicks at a point of the page; with Alt one thing of a group. */
  async click(to, { modifier = null } = {}) {
    await this.glide(to);
    if (modifier) await this.page.keyboard.down(modifier);
    await this.page.mouse.click(to.x, to.y);
    if (modifier) await this.page.keyboard.up(modifier);
    await this.page.waitForTimeout(250);
  }

  async drag(from, to, options = {}) {
    await this.glide(from);
    await this.page.mouse.down(options);
    await this.glide(to, { draws: true, ...options });
    await this.page.mouse.up(options);
    await this.page.waitForTimeout(250);
  }

  /** Does nothing for so many seconds of a smooth recording. */
  async hold(seconds = 1) {
    if (this.hurries) return;
    for (let second = 0; second < seconds; ++second) {
      await this.page.waitForTimeout(1500);
      await this.page.mouse.move(this.at.x + (second % 2 ? 0 : 1), this.at.y);
    }
  }

  async focusScene() {
    await this.page.evaluate(() => document.querySelector('[data-testid="canvas"]').focus());
  }

  /** A key for the scene. */
  async key(name) {
    await this.focusScene();
    await this.page.keyboard.press(name);
    await this.page.waitForTimeout(350);
  }

  /** A command by Ctrl+K. */
  async run(words) {
    await this.focusScene();
    await this.page.keyboard.press("Control+k");
    await this.page.getByTestId("palette-input").fill(words);
    await this.page.keyboard.press("Enter");
  }

  async select(indices) {
    await this.page.getByTestId("tab-In the scene").click();
    for (const [at, index] of indices.entries()) await this.page.locator(`[data-testid=hierarchy] [data-index="${index}"]`).click(at > 0 ? { modifiers: ["Control"] } : {});
    await this.page.getByTestId("tab-Models").click();
    await this.page.waitForFunction((count) => window.embody.selection().length === count, indices.length);
  }

  /** Types a value into the field of the properties with this label; groups that are folded are opened. */
  async type(label, value) {
    const field = this.page.getByTestId("properties").getByLabel(label, { exact: true }).first();
    await field.evaluate((each) => {
      for (let group = each.closest("details"); group; group = group.parentElement.closest("details")) group.open = true;
    });
    await field.fill(String(value));
    await field.press("Enter");
    await this.page.waitForTimeout(300);
  }

  /** Drags what `source` offers to a point of the world; returns the new entity. */
  async dragIn(source, point, { turns = 0, name = "" } = {}) {
    const before = new Set((await this.entities()).map(({ index }) => index));
    await source.scrollIntoViewIfNeeded();
    const box = await source.boundingBox();
    await this.page.mouse.move(box.x + box.width / 2, box.y + box.height / 2);
    this.at = { x: box.x + box.width / 2, y: box.y + box.height / 2 };
    await this.page.mouse.down();
    const canvas = await this.canvas();
    const to = await this.project(point);
    // Over the panel nothing is seen.
    await this.glide({ x: canvas.x + 4, y: to.y * 0.5 + this.at.y * 0.5 }, { steps: 3 });
    await this.glide(to, { draws: true });
    await this.page.waitForTimeout(200);
    await this.page.mouse.up();
    const isNew = (known) => window.embody.entities().some(({ index, drawn }) => drawn && !known.includes(index));
    await this.page.waitForFunction(isNew, [...before], { timeout: 60000 });
    await this.page.waitForFunction(() => window.embody.loading() === 0, null, { timeout: 60000 });
    const [made] = (await this.entities()).filter(({ index }) => !before.has(index));
    for (let turn = 0; turn < Math.abs(turns); ++turn) await this.key(turns > 0 ? "[" : "]");
    if (name) await this.type("Name", name);
    return this.entity(made.index);
  }

  /** A model of the library, found by words; its key says which. */
  async place(words, key, point, options) {
    await this.page.getByTestId("search").fill(words);
    const tile = this.page.locator(`[data-testid=model-tile][data-key="${key}"]`);
    await tile.waitFor({ timeout: 30000 });
    await this.page.waitForTimeout(400);
    return this.dragIn(tile, point, options);
  }

  primitive(name, point, options) {
    return this.dragIn(this.page.getByTestId(`primitive-${name}`), point, options);
  }

  /** A place on the page from where a drag turns the camera: empty, or one of the things that stay. */
  async emptyPlace(fixed) {
    const { x, y, width, height } = await this.canvas();
    for (const [right, down] of [[0.5, 0.06], [0.12, 0.1], [0.88, 0.1], [0.08, 0.85], [0.92, 0.85], [0.5, 0.9], [0.3, 0.9], [0.7, 0.9]]) {
      const at = { x: x + right * width, y: y + down * height };
      const index = await this.page.evaluate(({ x, y }) => window.embody.pick(x, y), at);
      if (index === null || fixed.includes(index)) return at;
    }
    throw new Error("no place is empty");
  }

  /** Turns, shifts and zooms until the camera is there, near enough, as a user does; from far, where the target is not in the picture. */
  async lookFrom(position, target, fixed = [], { steps = 30 } = {}) {
    const spherical = (camera) => new Spherical().setFromVector3(new Vector3(...camera.position).sub(new Vector3(...camera.target)));
    const wanted = spherical({ position, target });
    const camera = () => this.page.evaluate(() => window.embody.camera());
    if (!(await this.isInView(target))) {
      await this.key("Escape");
      await this.key("f");
      await this.page.waitForTimeout(700);
    }
    const now = spherical(await camera());
    let angle = now.theta - wanted.theta;
    angle -= 2 * Math.PI * Math.round(angle / (2 * Math.PI));
    const turn = { x: angle / ORBIT_PER_PIXEL, y: (now.phi - wanted.phi) / ORBIT_PER_PIXEL };
    await this.dragBy(turn, steps, fixed, "left");
    if (!(await this.isInView(target))) throw new Error(`${target} is not in the picture`);
    await this.shiftToMiddle(target, steps, fixed);
    // The camera turns about another point of the ray through its target.
    const seen = await camera();
    const arm = spherical(seen).radius;
    const tooFar = new Vector3(...target).distanceTo(new Vector3(...seen.position)) - wanted.radius;
    const notches = Math.log(Math.max(arm - tooFar, 0.3) / arm) / Math.log(ZOOM_PER_NOTCH);
    const count = Math.max(1, Math.ceil(Math.abs(notches) * 3));
    // The last drag may have ended beside the picture.
    const { x, y, width, height } = await this.canvas();
    await this.glide({ x: x + width / 2, y: y + height / 2 }, { steps: 6 });
    for (let at = 0; at < count && Math.abs(notches) > 0.1; ++at) {
      const frames = await this.page.evaluate(() => window.embody.frames());
      await this.page.mouse.wheel(0, (notches / count) * 100);
      await this.page.waitForFunction((frames) => window.embody.frames() > frames, frames, { timeout: PICTURE_MS, polling: 10 }).catch(() => {});
    }
    await this.shiftToMiddle(target, 6, fixed);
  }

  /** Whether a point of the world is before the camera and on the canvas. */
  async isInView(point) {
    const { position, target } = await this.page.evaluate(() => window.embody.camera());
    const ahead = new Vector3(...target).sub(new Vector3(...position));
    const { x, y, width, height } = await this.canvas();
    const at = await this.project(point);
    return ahead.dot(new Vector3(...point).sub(new Vector3(...position))) > 0 && at.x > x && at.y > y && at.x < x + width && at.y < y + height;
  }

  async shiftToMiddle(point, steps, fixed) {
    for (let times = 0; times < 4; ++times) {
      const { x, y, width, height } = await this.canvas();
      const at = await this.project(point);
      const shift = { x: x + width / 2 - at.x, y: y + height / 2 - at.y };
      if (Math.hypot(shift.x, shift.y) < 3) break;
      // What is as far as the camera's target follows the pointer; what is nearer goes farther.
      const camera = await this.page.evaluate(() => window.embody.camera());
      const arm = new Vector3(...camera.target).sub(new Vector3(...camera.position));
      const depth = arm.dot(new Vector3(...point).sub(new Vector3(...camera.position))) / arm.lengthSq();
      await this.dragBy({ x: shift.x * depth, y: shift.y * depth }, times === 0 ? steps : 6, fixed, "middle");
    }
  }

  async dragBy(way, steps, fixed, button) {
    if (Math.hypot(way.x, way.y) < 3) return;
    const from = await this.emptyPlace(fixed);
    await this.glide(from, { steps: 6 });
    await this.page.mouse.down({ button });
    await this.glide({ x: from.x + way.x, y: from.y + way.y }, { steps, draws: true });
    await this.page.mouse.up({ button });
    await this.page.waitForTimeout(150);
  }

  /** Runs a download that `start` causes; its file. */
  async download(start, path) {
    const [file] = await Promise.all([this.page.waitForEvent("download", { timeout: 3_600_000 }), start()]);
    await file.saveAs(path);
    return path;
  }

  /** Begins a recording of what is done. */
  async record(text, { isSmooth = true, tells = true } = {}) {
    await this.run("record what");
    await this.page.getByTestId("record-pace").selectOption(isSmooth ? "smooth" : "clock");
    await this.page.getByTestId("record-text").fill(text);
    await this.page.getByTestId("record-tells").setChecked(tells);
    await this.page.getByTestId("record-start").click();
    await this.page.getByTestId("recording").waitFor();
    await this.page.waitForTimeout(1200);
  }

  endRecording(path) {
    return this.download(() => this.page.getByTestId("recording-end").click(), path);
  }

  /** Films a part of the run. */
  async film(path, { from, to, rate = 1, fps = 24, size, camera = 0, text = "" }) {
    await this.page.getByTestId("time.film").click();
    await this.page.getByTestId("film-from").fill(from.toFixed(2));
    await this.page.getByTestId("film-to").fill(to.toFixed(2));
    await this.page.getByTestId("film-rate").selectOption(String(rate));
    await this.page.getByTestId("film-fps").selectOption(String(fps));
    await this.page.getByTestId("film-size").selectOption(size);
    await this.page.getByTestId("film-camera").selectOption(String(camera));
    await this.page.getByTestId("film-text").fill(text);
    return this.download(() => this.page.getByTestId("film-start").click(), path);
  }
}
