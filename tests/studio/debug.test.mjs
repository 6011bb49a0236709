// SPDX-License-Identifier: MIT
// Debug drawings of the solver over the picture: docs/physics/debugging.md.
import assert from "node:assert/strict";
import { after, before, beforeEach, describe, it } from "node:test";
import { difference, pictureOfScene } from "./browser.mjs";
import { Session } from "./session.mjs";

const box = (index, y) => ({ index, shape: { type: "box", half_extents: [0.5, 0.5, 0.5] }, pose: { position: [0, y, 0] } });
const SCENE = {
  embody_scene: 1,
  title: "Two boxes",
  entities: [{ index: 1, name: "Floor", shape: { type: "plane", normal: [0, 1, 0], offset: 0 }, attributes: { kind: "static" } }, box(2, 0.5), box(3, 1.5)],
  camera: { position: [3, 2, 4], target: [0, 1, 0] },
};
// Numbers of docs/protocol.md.
const STATIC = 0;
const ACTIVE = 2;
const WANTS_TO_SLEEP = 3;
const ASLEEP = 4;
const CONTACT = 6;
const NORMAL = 7;

describe("debug drawing in the Studio", { timeout: 900000 }, () => {
  const session = new Session();
  let page;

  before(() => session.start(SCENE));
  after(() => session.end());
  beforeEach(async () => {
    page = await session.reopen();
    await session.command("scene.load", { scene: SCENE });
  });

  const counts = () => page.evaluate(() => window.embody.debugCounts());
  async function tick(...names) {
    await page.getByTestId("view.options").click();
    for (const name of names) await page.getByTestId(`debug-${name}`).click();
    await page.keyboard.press("Escape");
  }

  it("draws contacts and shapes while their boxes are ticked", async () => {
    await session.command("simulation.step", { count: 3 });
    assert.deepEqual(await counts(), {});
    const plain = await pictureOfScene(page);
    await tick("contacts", "shapes");
    // Each box that is ticked is told by itself: a frame may have the contacts alone.
    await page.waitForFunction(([contact, still]) => window.embody.debugCounts()[contact]?.points === 8 && window.embody.debugCounts()[still], [CONTACT, STATIC]);
    const seen = await counts();
    assert.deepEqual(seen[CONTACT], { lines: 0, points: 8 });
    assert.deepEqual(seen[NORMAL], { lines: 8, points: 0 });
    // The box is slow enough to want to sleep.
    assert.deepEqual(seen[WANTS_TO_SLEEP], { lines: 24, points: 0 });
    assert.equal(seen[STATIC].lines, 22);
    const share = await difference(page, plain, await pictureOfScene(page));
    assert.ok(share > 0.003 && share < 0.2, `${share} of the picture`);
    await tick("contacts", "shapes");
    await page.waitForFunction(() => Object.keys(window.embody.debugCounts()).length === 0);
    assert.ok((await difference(page, plain, await pictureOfScene(page))) < 0.001);
    assert.deepEqual(page.faults, []);
  });

  it("shows how much did not fit into a frame, as long as that is so", async () => {
    // 180 × 180 samples have 96,839 edges; a frame has 60,000 lines.
    const size = 180;
    const heights = Array.from({ length: size * size }, (_, i) => 0.1 * ((i * 7919) % 11));
    const shape = { type: "heightfield", columns: size, rows: size, cell_x: 1, cell_z: 1, heights };
    await session.command("scene.load", { scene: { ...SCENE, entities: [...SCENE.entities, { index: 9, name: "Hills", shape, attributes: { kind: "static" } }] } });
    await tick("shapes");
    await page.getByTestId("view.options").click();
    const told = page.getByTestId("debug-left-out");
    await told.waitFor();
    const edges = 2 * size * (size - 1) + (size - 1) ** 2;
    const notDrawn = edges + 24 + 22 - 60000; // besides the edges of the two boxes and the plane's grid
    assert.equal(await told.textContent(), `${notDrawn.toLocaleString("en")} lines not drawn`);
    await page.getByTestId("debug-shapes").click();
    await told.waitFor({ state: "hidden" });
    assert.deepEqual(page.faults, []);
  });

  it("follows the simulation, and is there again after a reload", async () => {
    await tick("shapes");
    await page.waitForFunction((active) => window.embody.debugCounts()[active]?.lines === 24, ACTIVE);
    await session.command("simulation.play");
    await page.waitForFunction((asleep) => window.embody.debugCounts()[asleep]?.lines === 24, ASLEEP);
    await session.command("simulation.pause");
    await page.reload();
    await page.waitForFunction((asleep) => window.embody?.debugCounts()[asleep]?.lines === 24, ASLEEP);
    assert.deepEqual(page.faults, []);
  });
});
