// SPDX-License-Identifier: MIT
// Walls, rooms, doors and windows built in the page, the plan, levels and sizes.
import assert from "node:assert/strict";
import { after, before, beforeEach, describe, it } from "node:test";
import { takePicture } from "./browser.mjs";
import { allDone, Session, until } from "./session.mjs";

const GROUND = {
  embody_scene: 1,
  title: "Ground to build on",
  entities: [
    {
      index: 1,
      name: "Ground",
      category: "ground",
      shape: { type: "box", half_extents: [15, 0.25, 15] },
      attributes: { kind: "static" },
      pose: { position: [0, -0.25, 0] },
      locked: true,
    },
  ],
  camera: { position: [0, 9, 9], target: [0, 0, 0] },
};

describe("rooms", { timeout: 600000 }, () => {
  const session = new Session();
  let page;

  before(() => session.start(GROUND));
  after(() => session.end());
  beforeEach(async () => {
    page = await session.reopen({ height: 720 });
    await session.command("scene.load", { scene: GROUND });
    await drawn(1);
  });

  const picture = (name) => process.env.EMBODY_TEST_PICTURES && takePicture(page, `${process.env.EMBODY_TEST_PICTURES}/${name}.png`);
  const drawn = (count) => page.waitForFunction((count) => window.embody.entities().filter((entity) => entity.drawn).length === count, count, { timeout: 60000 });
  const project = (...point) => page.evaluate((point) => window.embody.project(...point), point);
  const scene = async () => (await session.command("hello")).scene;
  const shapes = async (type) => (await scene()).entities.filter((entity) => entity.shape?.type === type);
  const near = (value, expected, within = 0.02) => assert.ok(Math.abs(value - expected) < within, `${value} is not ${expected}`);
  async function click(...point) {
    const at = await project(...point);
    await page.mouse.move(at.x, at.y, { steps: 2 });
    await page.mouse.click(at.x, at.y);
  }
  async function choose(what) {
    if (!(await page.getByTestId("build-bar").isVisible())) await page.locator("header").getByTestId("build.wall").click();
    if (what !== "wall") await page.getByTestId("build-bar").getByTestId(`build.${what}`).click();
  }
  async function buildRoom() {
    await choose("room");
    const [from, to] = [await project(-2, 0, -1.5), await project(2, 0, 1.5)];
    await page.mouse.move(from.x, from.y);
    await page.mouse.down();
    await page.mouse.move((from.x + to.x) / 2, (from.y + to.y) / 2);
    await page.mouse.move(to.x, to.y, { steps: 3 });
    const told = await page.getByTestId("build-length").textContent();
    await picture("room-drawn");
    await page.mouse.up();
    await drawn(6);
    return told;
  }
  const leave = async () => {
    await page.keyboard.press("Escape");
    await page.getByTestId("build-bar").waitFor({ state: "hidden" });
  };

  it("builds a room by a drag, with its size shown, in one step of undo", async () => {
    assert.equal(await buildRoom(), "4.00 m × 3.00 m");
    const walls = await shapes("wall");
    assert.equal(walls.length, 4);
    assert.deepEqual(walls.map(({ shape }) => Math.round(shape.length * 100) / 100).sort(), [3, 3, 4, 4]);
    for (const { shape, locked } of walls) {
      near(Math.abs(shape.start_cut[0]), 0.06, 0.001);
      assert.ok(locked);
    }
    assert.equal((await shapes("slab")).length, 1);
    await leave();
    await picture("room-built");
    await page.keyboard.press("Control+z");
    await drawn(1);
    assert.deepEqual(page.faults, []);
  });

  it("draws walls from click to click, by a typed length too, and lays a floor where they close", async () => {
    await choose("wall");
    await click(-2, 0, -1);
    await click(2, 0, -1);
    await drawn(2);
    const next = await project(2, 0, 0.5);
    await page.mouse.move(next.x, next.y, { steps: 2 });
    await page.keyboard.type("2.5");
    assert.equal(await page.getByTestId("build-length").textContent(), "2.5 m");
    await page.keyboard.press("Enter");
    await drawn(3);
    const typed = (await shapes("wall")).at(-1);
    near(typed.shape.length, 2.5, 1e-6);
    await click(-2, 0, 1.5);
    await drawn(4);
    await click(-2, 0, -1);
    await drawn(6);
    const [floor] = await shapes("slab");
    assert.equal(floor.shape.points.length, 4);
    await leave();
    assert.deepEqual(page.faults, []);
  });

  it("puts doors and windows into walls, drags them along, and undoes", async () => {
    await buildRoom();
    await choose("window");
    await click(0, 1.5, -1.44);
    const back = async () => (await shapes("wall")).find(({ shape }) => shape.openings?.length);
    // The wall is selected at once; the server has the window when it has answered.
    await page.waitForFunction(() => window.embody.selection().length === 1);
    const wall = await until(back, Boolean, "a wall with a window");
    assert.equal(wall.shape.openings[0].kind, "window");
    near(wall.shape.openings[0].offset, 1.4, 0.1);
    await choose("door");
    await click(1.99, 1, 0);
    const doors = async () => (await shapes("wall")).flatMap(({ shape }) => shape.openings ?? []).filter(({ kind }) => kind === "door");
    const [{ sill, height }] = await until(doors, ({ length }) => length === 1, "a door");
    assert.deepEqual([sill, height], [0, 2.1]);
    await leave();
    await picture("room-openings");

    // The window along its wall: it is selected by a click on it first.
    await click(-1.2, 2.2, -1.44);
    await page.waitForFunction((index) => window.embody.selection().includes(index), wall.index);
    // All of the room is one group: the wall alone with Alt.
    await page.keyboard.down("Alt");
    await click(-1.2, 2.2, -1.44);
    await page.keyboard.up("Alt");
    await page.waitForFunction((index) => window.embody.selection().length === 1 && window.embody.selection()[0] === index, wall.index);
    const from = await project(0, 1.5, -1.5);
    const to = await project(0.8, 1.5, -1.5);
    await page.mouse.move(from.x, from.y);
    await page.mouse.down();
    await page.mouse.move(to.x, to.y, { steps: 4 });
    await page.mouse.up();
    // The last place is sent when the one before has been answered.
    await allDone(page);
    near((await back()).shape.openings[0].offset, 2.2, 0.12);
    await page.keyboard.press("Control+z");
    await allDone(page);
    near((await back()).shape.openings[0].offset, 1.4, 0.1);
    assert.deepEqual(page.faults, []);
  });

  it("puts a door of the catalogue into the wall under the pointer, and cuts the wall", async () => {
    await buildRoom();
    await leave();
    const { models } = await session.command("catalog.search", { words: "door", limit: 50 });
    const door = models.find(({ category, size }) => category === "door" && size[1] > 1.8 && size[1] < 2.3 && size[0] < 1.2);
    assert.ok(door, "the catalogue has no door");
    const { index } = await session.command("entity.add", { entity: { model: door.key }, drop: { origin: [0.5, 1, 5], direction: [0, 0, -1] } });
    await drawn(7);
    const wall = (await shapes("wall")).find(({ shape }) => shape.openings?.some(({ entity }) => entity === index));
    assert.ok(wall, "no wall has its opening");
    near(wall.shape.openings[0].width, door.size[0], 1e-4);
    await picture("room-door");
  });

  it("shows the plan and back, and hides what is above in it", async () => {
    await buildRoom();
    await leave();
    await session.command("entity.add", { entity: { name: "Lid", shape: { type: "box", half_extents: [2, 0.05, 1.5] }, pose: { position: [0, 2.7, 0] } } });
    await drawn(7);
    const before = await page.evaluate(() => window.embody.camera());
    await page.keyboard.press("p");
    await drawn(6);
    // Without perspective the top of a wall lies over its foot.
    const [foot, top] = [await project(2, 0, 1.5), await project(2, 2.5, 1.5)];
    near(foot.x, top.x, 3);
    near(foot.y, top.y, 3);
    const east = await project(3, 0, 1.5);
    assert.ok(east.x > foot.x && Math.abs(east.y - foot.y) < 1, "east is right");
    await picture("plan");
    await page.keyboard.press("p");
    await drawn(7);
    const after = await page.evaluate(() => window.embody.camera());
    before.position.forEach((each, axis) => near(after.position[axis], each, 0.01));
    assert.deepEqual(page.faults, []);
  });

  it("adds levels, builds on the chosen one and hides those above", async () => {
    await page.keyboard.press("p");
    await page.getByTestId("level-add").click();
    await page.waitForFunction(() => document.querySelectorAll('[data-testid="levels"] option').length === 2);
    await page.keyboard.press("p");
    await buildRoomAbove();
    for (const wall of await shapes("wall")) near(wall.pose.position[1], 2.7, 1e-6);
    await page.getByTestId("levels").selectOption({ index: 0 });
    await page.getByTestId("hide-above").check();
    await drawn(1);
    await page.getByTestId("hide-above").uncheck();
    await drawn(6);
    await picture("levels");
    assert.deepEqual(page.faults, []);
  });

  async function buildRoomAbove() {
    await choose("room");
    const [from, to] = [await project(-1, 2.7, -1), await project(1, 2.7, 1)];
    await page.mouse.move(from.x, from.y);
    await page.mouse.down();
    await page.mouse.move(to.x, to.y, { steps: 3 });
    await page.mouse.up();
    await drawn(6);
    await leave();
  }

  it("shows size and distances to the walls while something is dragged in the plan", async () => {
    await buildRoom();
    await leave();
    await session.command("entity.add", { entity: { name: "Crate", shape: { type: "box", half_extents: [0.25, 0.25, 0.25] }, pose: { position: [0, 0.2551, 0] } } });
    await drawn(7);
    // In the plan no wall is before the crate.
    await page.keyboard.press("p");
    const from = await project(0, 0.5, 0);
    const to = await project(0.6, 0.5, 0.3);
    await page.mouse.move(from.x, from.y);
    await page.mouse.down();
    await page.mouse.move(from.x + 8, from.y + 4, { steps: 3 });
    await page.mouse.move(to.x, to.y, { steps: 6 });
    await page.waitForFunction(() => [...document.querySelectorAll('[data-testid="measure-distance"]')].filter((label) => !label.hidden).length === 4);
    assert.match(await page.getByTestId("measure-size").textContent(), /^Crate: 50 cm × 50 cm × 50 cm$/);
    await picture("measures");
    await page.mouse.up();
    await page.waitForFunction(() => [...document.querySelectorAll('[data-testid="measure-size"]')].every((label) => label.hidden));
    assert.deepEqual(page.faults, []);
  });
});
