// SPDX-License-Identifier: MIT
// An emulated headset (iwer) in a page of the Studio: puts it on, moves head and hands, presses buttons, and reads the picture.
import { createRequire } from "node:module";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";

const RUNTIME = join(dirname(createRequire(fileURLToPath(new URL("../../studio/package.json", import.meta.url))).resolve("iwer")), "../build/iwer.min.js");

/** Lets a page find an emulated Quest 3. `planes` are surfaces of its real room: {label, position, rotation?, polygon: [[x, z]…]}. */
export async function wearHeadset(page, planes = []) {
  await page.addInitScript({ path: RUNTIME });
  await page.addInitScript((planes) => {
    const device = new IWER.XRDevice(IWER.metaQuest3, { stereoEnabled: true });
    device.installRuntime({ forceInstall: true });
    device.stereoEnabled = true;
    window.device = device;
    window.pulses = [];
    // The emulated actuators do nothing; what they are told is kept.
    for (const side of ["left", "right"]) {
      const actuator = device.controllers[side].inputSource.gamepad.hapticActuators[0];
      if (actuator) actuator.pulse = (strength, milliseconds) => (window.pulses.push({ side, strength, milliseconds }), Promise.resolve(true));
    }
    // What the emulator's module of rooms would tell.
    const found = planes.map(({ label, position: [x, y, z], polygon }) => {
      const place = new XRRigidTransform({ x, y, z, w: 1 }, { x: 0, y: 0, z: 0, w: 1 });
      return { transform: place, polygon: polygon.map(([x, z]) => new DOMPointReadOnly(x, 0, z)), semanticLabel: label };
    });
    if (found.length > 0) {
      const sem = { trackedPlanes: new Set(found), trackedMeshes: new Set(), render() {}, environmentCanvas: document.createElement("canvas") };
      Object.getOwnPropertySymbols(device).forEach((symbol) => device[symbol]?.viewSpaces && (device[symbol].sem = sem));
    }
  }, planes);
}

/** Turns so that the ray along -Z goes from one point to another. */
function lookRotation(from, to) {
  const forth = unit([to[0] - from[0], to[1] - from[1], to[2] - from[2]]);
  const back = forth.map((each) => -each);
  const right = unit(Math.abs(forth[1]) > 0.999 ? [1, 0, 0] : cross([0, 1, 0], back));
  const up = cross(back, right);
  return quaternionOf(right, up, back);
}

function quaternionOf(x, y, z) {
  const trace = x[0] + y[1] + z[2];
  if (trace > 0) {
    const s = 2 * Math.sqrt(trace + 1);
    return [(y[2] - z[1]) / s, (z[0] - x[2]) / s, (x[1] - y[0]) / s, s / 4];
  }
  if (x[0] > y[1] && x[0] > z[2]) {
    const s = 2 * Math.sqrt(1 + x[0] - y[1] - z[2]);
    return [s / 4, (y[0] + x[1]) / s, (z[0] + x[2]) / s, (y[2] - z[1]) / s];
  }
  if (y[1] > z[2]) {
    const s = 2 * Math.sqrt(1 + y[1] - x[0] - z[2]);
    return [(y[0] + x[1]) / s, s / 4, (z[1] + y[2]) / s, (z[0] - x[2]) / s];
  }
  const s = 2 * Math.sqrt(1 + z[2] - x[0] - y[1]);
  return [(z[0] + x[2]) / s, (z[1] + y[2]) / s, s / 4, (x[1] - y[0]) / s];
}

function cross(a, b) {
  return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
}

function unit(v) {
  const length = Math.hypot(...v);
  return v.map((each) => each / length);
}

/** The headset of a page that wearHeadset prepared. Points are in the scene unless they say room. */
export class Headset {
  constructor(page) {
    this.page = page;
  }

  async enter(button = "enter-vr") {
    await this.page.getByTestId(button).click();
    // Until the device asks for pictures those that are drawn are the page's own.
    await this.page.waitForFunction(() => window.embody.vr.running() && window.embody.vr.foveation() !== undefined, null, { timeout: 120000 });
    await this.frames(4);
  }

  async leave() {
    await this.page.evaluate(() => window.device.activeSession?.end());
    await this.page.waitForFunction(() => !window.embody.vr.running());
  }

  /** Waits for so many more pictures. */
  async frames(count = 3) {
    const now = await this.page.evaluate(() => window.embody.frames());
    await this.page.waitForFunction((until) => window.embody.frames() >= until, now + count, { timeout: 180000 });
  }

  /** Waits until the Studio has counted so many seconds: of a picture that took longer it counts a tenth. */
  async seconds(count) {
    for (let tenth = 0; tenth <= 10 * count; ++tenth) {
      await this.page.waitForTimeout(100);
      await this.frames(1);
    }
  }

  stance() {
    return this.page.evaluate(() => window.embody.vr.stance());
  }

  async hand(side) {
    return (await this.page.evaluate(() => window.embody.vr.hands())).find((hand) => hand.side === side);
  }

  toRoom(point) {
    return this.page.evaluate((at) => window.embody.vr.toRoom(at), point);
  }

  /** Sets a controller or hand in the room. */
  async place(side, position, rotation = [0, 0, 0, 1]) {
    await this.page.evaluate(
      ([side, [x, y, z], [a, b, c, d]]) => {
        for (const input of [window.device.controllers[side], window.device.hands[side]]) {
          input.position.set(x, y, z);
          input.quaternion.set(a, b, c, d);
        }
      },
      [side, position, rotation],
    );
  }

  /** Holds a hand in the room so that its ray goes through a point of the room. */
  async aimInRoom(side, to, from = [side === "left" ? -0.2 : 0.2, 1.3, -0.15]) {
    await this.place(side, from, lookRotation(from, to));
    await this.frames(4);
  }

  /** Holds a hand so that its ray goes through a point of the scene. */
  async aim(side, point, from) {
    await this.aimInRoom(side, await this.toRoom(point), from);
  }

  /** Moves a hand from where it is to a place of the room in steps, one a picture. */
  async sweep(side, to, steps = 6, rotation = null) {
    const from = await this.page.evaluate((side) => [...window.device.controllers[side].position.vec3], side);
    for (let at = 1; at <= steps; ++at) {
      const place = from.map((each, axis) => each + ((to[axis] - each) * at) / steps);
      const turn = rotation ?? (await this.page.evaluate((side) => [...window.device.controllers[side].quaternion.quat], side));
      await this.place(side, place, turn);
      await this.frames(1);
    }
    await this.frames(2);
  }

  /** Moves a hand evenly by the page's own clock, m/s in the room, for so long, and lets a button go in full motion. */
  async swing(side, velocity, seconds, button) {
    await this.page.evaluate(
      ([side, velocity, seconds, button]) =>
        new Promise((done) => {
          const controller = window.device.controllers[side];
          const from = [...controller.position.vec3];
          const start = performance.now();
          const step = () => {
            const time = (performance.now() - start) / 1000;
            controller.position.set(...from.map((each, axis) => each + velocity[axis] * time));
            if (time > seconds) controller.updateButtonValue(button, 0);
            if (time > seconds + 0.3) done();
            else requestAnimationFrame(step);
          };
          step();
        }),
      [side, velocity, seconds, button],
    );
  }

  async set(side, button, value) {
    await this.page.evaluate(([side, button, value]) => window.device.controllers[side].updateButtonValue(button, value), [side, button, value]);
    await this.frames(3);
  }

  async press(side, button = "trigger") {
    await this.set(side, button, 1);
    await this.set(side, button, 0);
  }

  async stick(side, x, y, frames = 3) {
    await this.page.evaluate(([side, x, y]) => window.device.controllers[side].updateAxes("thumbstick", x, y), [side, x, y]);
    await this.frames(frames);
  }

  async pinch(side, value) {
    await this.page.evaluate(([side, value]) => window.device.hands[side].updatePinchValue(value), [side, value]);
    await this.frames(3);
  }

  widgets() {
    return this.page.evaluate(() => window.embody.vr.widgets());
  }

  /** A widget that is shown, by its id. */
  async widget(id) {
    await this.page.waitForFunction((id) => window.embody.vr.widgets().some((each) => each.id === id), id, { timeout: 60000 });
    return (await this.widgets()).find((each) => each.id === id);
  }

  /** Points at a widget and pulls the trigger, as a user presses a button. */
  async click(id, side = "right") {
    const { at } = await this.widget(id);
    await this.aimInRoom(side, at);
    await this.press(side);
  }

  async look(position, to) {
    const turn = lookRotation(position, to);
    await this.page.evaluate(
      ([[x, y, z], [a, b, c, d]]) => {
        window.device.position.set(x, y, z);
        window.device.quaternion.set(a, b, c, d);
      },
      [position, turn],
    );
    await this.frames(3);
  }

  /** The stereo picture as a PNG file's bytes. */
  async picture() {
    const data = await this.page.evaluate(() => window.embody.vr.picture());
    return Buffer.from(data.split(",")[1], "base64");
  }
}
