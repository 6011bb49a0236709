// SPDX-License-Identifier: MIT
// Building with one's hands: things that are dropped, dragged, copied, grouped and turned in a room, with models of the real catalogue.
import assert from "node:assert/strict";
import { after, before, beforeEach, describe, it } from "node:test";
import { takePicture } from "./browser.mjs";
import { allDone, searchFor, Session, settled } from "./session.mjs";

const fixed = (name, size, position, color = [0.8, 0.78, 0.72]) => ({
  name,
  shape: { type: "box", half_extents: size.map((length) => length / 2) },
  attributes: { kind: "static" },
  pose: { position },
  color,
});
const ROOM = {
  embody_scene: 1,
  title: "Room to furnish",
  entities: [
    fixed("Floor", [6, 0.2, 6], [0, -0.1, 0], [0.45, 0.33, 0.2]),
    fixed("Back wall", [6, 2.8, 0.2], [0, 1.4, -3.1]),
    fixed("Left wall", [0.2, 2.8, 6], [-3.1, 1.4, 0]),
  ],
  camera: { position: [2.6, 2.4, 4.6], target: [-0.3, 0.7, -1] },
};
const WALL = -3;

describe("building in a room", { timeout: 900000 }, () => {
  const session = new Session();
  let page;

  before(() => session.start(ROOM));
  after(() => session.end());
  beforeEach(async () => {
    page = await session.reopen({ height: 720 });
    await load(ROOM);
  });

  async function load(scene) {
    await session.command("scene.load", { scene });
    await page.waitForFunction((title) => document.title.includes(title), scene.title);
    await drawn(scene.entities.length);
  }
  // For a person to look at, where a folder for them is named.
  const picture = (name) => process.env.EMBODY_TEST_PICTURES && takePicture(page, `${process.env.EMBODY_TEST_PICTURES}/${name}.png`);
  const drawn = (count) => page.waitForFunction((count) => window.embody.entities().filter((entity) => entity.drawn).length === count, count, { timeout: 60000 });
  const entities = () => page.evaluate(() => window.embody.entities());
  const entity = async (index) => (await entities()).find((each) => each.index === index);
  const project = (...point) => page.evaluate((point) => window.embody.project(...point), point);
  const selection = () => page.evaluate(() => window.embody.selection());
  const modelOf = async (words, fits = () => true) => {
    const { models } = await session.command("catalog.search", { words, limit: 50 });
    const found = models.find(fits);
    assert.ok(found, `the catalogue has no ${words}`);
    return found;
  };
  // What stands where, told by the server: not by what the page interpolates.
  const bounds = async (index) => {
    const { scene } = await session.command("hello");
    const found = scene.entities.find((each) => each.index === index);
    return { ...found, size: (await session.command("catalog.search", { words: "", limit: 1000 })).models.find(({ key }) => key === found.model)?.size };
  };
  async function add(words, from, to, fits) {
    const model = await modelOf(words, fits);
    const direction = to.map((each, axis) => each - from[axis]);
    const before = (await entities()).length;
    const { index } = await session.command("entity.add", { entity: { model: model.key }, drop: { origin: from, direction } });
    await drawn(before + 1);
    return index;
  }
  const EYE = [2.6, 2.4, 4.6];
  async function drag(from, to) {
    await page.mouse.move(from.x, from.y);
    await page.mouse.down();
    await page.mouse.move(from.x + 6, from.y + 2, { steps: 2 });
    await page.mouse.move(to.x, to.y, { steps: 8 });
    await allDone(page);
    await page.mouse.up();
    await allDone(page);
  }

  it("lifts a laptop from the floor onto a table, in one step of undo", async () => {
    const table = await add("table", EYE, [-1, 0, 0], ({ category, size }) => category === "table" && size[1] > 0.6 && size[1] < 0.85 && size[0] > 1 && size[2] > 0.6);
    const laptop = await add("laptop", EYE, [1, 0, 0.5], ({ category }) => category === "computer");
    const standing = await bounds(table);
    const top = standing.size[1];
    const before = await bounds(laptop);
    assert.ok(Math.abs(before.pose.position[1]) < 0.02, "the laptop lies on the floor");
    const from = await page.evaluate((index) => window.embody.seenAt(index), laptop);
    await drag(from, await project(standing.pose.position[0], top, standing.pose.position[2]));
    const lifted = await bounds(laptop);
    assert.ok(Math.abs(lifted.pose.position[1] - top) < 0.03, `the laptop is at ${lifted.pose.position[1]}, the table's top at ${top}`);
    assert.deepEqual((await bounds(table)).pose, standing.pose, "the table stays");
    await picture("laptop");
    await page.keyboard.press("Control+z");
    await page.waitForFunction(([index, y]) => Math.abs(window.embody.entities().find((each) => each.index === index).position[1] - y) < 1e-3, [laptop, before.pose.position[1]]);
  });

  it("hangs a clock on a wall, where it stays in a run", async () => {
    const clock = await add("clock", EYE, [-1, 1.8, WALL], ({ category, size }) => category === "clock" && size[1] < 0.6);
    const hung = await bounds(clock);
    assert.ok(Math.abs(hung.pose.position[2] - hung.size[2] / 2 - WALL) < 0.02, `its back is at the wall: ${hung.pose.position[2]}, ${hung.size}`);
    await session.command("simulation.step", { count: 180 });
    await page.waitForFunction(() => window.embody.simulation().step === 180);
    await allDone(page);
    const after = await entity(clock);
    hung.pose.position.forEach((each, axis) => assert.ok(Math.abs(each - after.position[axis]) < 1e-3, `it hangs where it was: ${after.position} for ${hung.pose.position}, state ${after.state}`));
    await session.command("simulation.reset");
    // Along the wall by the mouse, and round the corner to the other one.
    await drag(await page.evaluate((index) => window.embody.seenAt(index), clock), await project(-3, 1.6, -1));
    const moved = await bounds(clock);
    assert.ok(Math.abs(moved.pose.position[0] - moved.size[2] / 2 + 3) < 0.03, `it hangs on the left wall: ${moved.pose.position}`);
    assert.ok(Math.abs(moved.pose.rotation[1]) > 0.6, "and is turned to the room");
    await picture("clock");
  });

  it("turns a sofa's back to a wall that is near", async () => {
    const sofa = await add("sofa", EYE, [-2.6, 0, 0.5], ({ category, size }) => category === "sofa" && size[0] > 1.4 && size[2] < 1.1);
    const stands = await bounds(sofa);
    assert.ok(Math.abs(stands.pose.rotation[1] - Math.SQRT1_2) < 1e-3, `turned by a quarter: ${stands.pose.rotation}`);
    assert.ok(Math.abs(stands.pose.position[0] - stands.size[2] / 2 + 3) < 0.03, `at the wall: ${stands.pose.position}`);
    await picture("sofa");
  });

  it("shows the ghost where the drop ends, for 20 random drops", async () => {
    let seed = 5;
    const random = () => (seed = (seed * 16807) % 2147483647) / 2147483647;
    const words = ["chair", "lamp", "sofa", "vase", "cabinet", "clock", "table", "book"];
    const canvas = await page.getByTestId("canvas").boundingBox();
    for (let i = 0; i < 20; ++i) {
      await searchFor(page, words[i % words.length]);
      const count = (await entities()).length;
      const tile = await page.getByTestId("model-tile").first().boundingBox();
      await page.mouse.move(tile.x + tile.width / 2, tile.y + tile.height / 2);
      await page.mouse.down();
      await page.mouse.move(tile.x + 60, tile.y + 10, { steps: 2 });
      await page.mouse.move(canvas.x + canvas.width * (0.2 + 0.6 * random()), canvas.y + canvas.height * (0.25 + 0.65 * random()), { steps: 3 });
      await page.waitForFunction(() => window.embody.ghost(), null, { timeout: 30000 });
      // The ghost is where the server said last: not yet where the pointer is now.
      await allDone(page);
      const ghost = await page.evaluate(() => window.embody.ghost());
      if (i === 0) await picture("ghost");
      await page.mouse.up();
      await page.waitForFunction((count) => window.embody.entities().length > count, count);
      const { scene } = await session.command("hello");
      const { pose } = scene.entities.at(-1);
      pose.position.forEach((each, axis) => assert.ok(Math.abs(each - ghost.position[axis]) < 1e-6, `drop ${i}: ${pose.position} for ${ghost.position}`));
      if (i % 7 === 6) await session.command("scene.load", { scene: ROOM });
    }
    await picture("drops");
  });

  it("copies and pastes between scenes, and cuts", async () => {
    await page.context().grantPermissions(["clipboard-read", "clipboard-write"]);
    const chair = await add("chair", EYE, [0, 0, 0], ({ category }) => category === "chair");
    const seen = await page.evaluate((index) => window.embody.seenAt(index), chair);
    await page.mouse.click(seen.x, seen.y);
    assert.deepEqual(await selection(), [chair]);
    await page.keyboard.press("Control+c");
    await allDone(page);
    await load({ ...ROOM, title: "Another room" });
    await page.mouse.move(seen.x, seen.y + 60);
    await page.keyboard.press("Control+v");
    await drawn(4);
    // It is selected when the answer has come, after the event that draws it.
    await page.waitForFunction(() => window.embody.selection().length === 1);
    const [pasted] = await selection();
    assert.equal((await entity(pasted)).model, (await bounds(pasted)).model);
    await page.keyboard.press("Control+x");
    await drawn(3);
    await page.keyboard.press("Control+v");
    await drawn(4);
    // Moving the view with the middle button pastes nothing, as a middle click does elsewhere on Linux.
    await page.mouse.move(seen.x, seen.y - 200);
    await page.mouse.down({ button: "middle" });
    await page.mouse.move(seen.x + 30, seen.y - 200, { steps: 3 });
    await page.mouse.up({ button: "middle" });
    // Long enough for a text to come from the clipboard.
    await page.waitForTimeout(800);
    await allDone(page);
    assert.equal((await entities()).length, 4);
    assert.equal(await page.locator("[data-testid^=toast-]").getByText("clipboard").count(), 0);
  });

  it("offers what can be done by the right button, by keys and by the bar", async () => {
    const boxes = [];
    for (const x of [-1, 0, 1]) boxes.push((await session.command("entity.add", { entity: { shape: { type: "box", half_extents: [0.2, 0.2, 0.2] }, pose: { position: [x, 0.2, x / 3] } } })).index);
    await drawn(6);
    const at = await page.evaluate((index) => window.embody.seenAt(index), boxes[0]);
    await page.mouse.click(at.x, at.y, { button: "right" });
    const menu = page.getByTestId("context-menu");
    await menu.waitFor();
    await picture("menu");
    await page.getByTestId("menu.edit.duplicate").click();
    await drawn(7);
    // The copy is selected when the answer has come, after the event that draws it; until then the first one is.
    await page.waitForFunction((first) => window.embody.selection().length === 1 && window.embody.selection()[0] !== first, boxes[0]);
    await page.keyboard.press("Backspace");
    await drawn(6);
    await page.mouse.click(at.x, at.y);
    const start = (await entity(boxes[0])).position;
    await page.keyboard.press("ArrowRight");
    await page.keyboard.press("PageUp");
    await page.waitForFunction(([index, y]) => window.embody.entities().find((each) => each.index === index).position[1] > y + 0.005, [boxes[0], start[1]]);
    await page.keyboard.press("]");
    await page.waitForFunction((index) => Math.abs(window.embody.entities().find((each) => each.index === index).rotation[1]) > 0.1, boxes[0]);
    await page.getByLabel("Position x").fill("+=0.5");
    await page.getByLabel("Position x").press("Enter");
    await page.waitForFunction(([index, x]) => window.embody.entities().find((each) => each.index === index).position[0] > x + 0.4, [boxes[0], start[0]]);
    const moved = (await entity(boxes[0])).position;
    assert.ok(Math.abs(moved[0] - start[0] - 0.5) < 0.03, `${start} became ${moved}`);
    await page.getByTestId("canvas").focus();
    await page.keyboard.press("Control+a");
    await page.getByTestId("arrange-bar").waitFor();
    await picture("bar");
  });

  it("meets a thing under the pointer as soon as it is there, before the next picture", async () => {
    await page.evaluate(() => window.embody.halt());
    const boxes = [];
    for (const x of [-1, 0, 1]) boxes.push((await session.command("entity.add", { entity: { shape: { type: "box", half_extents: [0.2, 0.2, 0.2] }, pose: { position: [x, 0.2, 0] } } })).index);
    await drawn(6);
    for (const index of boxes) {
      const picked = await page.evaluate((index) => (({ x, y }) => window.embody.pick(x, y))(window.embody.seenAt(index)), index);
      assert.equal(picked, index);
    }
    await page.evaluate(() => window.embody.resume());
  });

  it("groups things that are then chosen and dragged together, as a tree", async () => {
    const boxes = [];
    for (const x of [-1, 0, 1]) boxes.push((await session.command("entity.add", { entity: { name: `Box ${x}`, shape: { type: "box", half_extents: [0.2, 0.2, 0.2] }, pose: { position: [x, 0.2, 0] } } })).index);
    await drawn(6);
    const seen = (index) => page.evaluate((index) => window.embody.seenAt(index), index);
    const first = await seen(boxes[0]);
    await page.mouse.click(first.x, first.y);
    await page.waitForFunction((index) => window.embody.selection().includes(index), boxes[0]);
    const second = await seen(boxes[1]);
    await page.keyboard.down("Shift");
    await page.mouse.click(second.x, second.y);
    await page.keyboard.up("Shift");
    await page.waitForFunction((index) => window.embody.selection().includes(index), boxes[1]);
    await page.keyboard.press("Control+g");
    await page.getByTestId("tab-In the scene").click();
    await page.locator('[data-group="Group"]').waitFor();
    await page.mouse.click(1, 1);
    const canvas = await page.getByTestId("canvas").boundingBox();
    await page.mouse.click(canvas.x + 20, canvas.y + 20);
    await page.mouse.click(first.x, first.y);
    assert.deepEqual((await selection()).sort(), boxes.slice(0, 2));
    assert.match(await page.getByTestId("group-hint").textContent(), /Group “Group”.*Alt/, "how to select one of them is said");
    const both = async () => (await entities()).filter(({ index }) => boxes.slice(0, 2).includes(index));
    const before = await both();
    await drag(first, { x: first.x + 60, y: first.y + 60 });
    // The page shows them where the server has them.
    const { pose } = await bounds(boxes[0]);
    await page.waitForFunction(([index, place]) => Math.hypot(...window.embody.entities().find((each) => each.index === index).position.map((each, axis) => each - place[axis])) < 1e-4, [boxes[0], pose.position]);
    const after = await both();
    const shift = (at) => after[at].position.map((each, axis) => each - before[at].position[axis]);
    assert.ok(Math.hypot(...shift(0)) > 0.1, "the group has moved");
    shift(0).forEach((each, axis) => assert.ok(Math.abs(each - shift(1)[axis]) < 1e-3, "both by the same"));
    // The third comes into the group by a drag in the tree, which is filled anew after an edit.
    await settled(page);
    await page.locator(`[data-testid=hierarchy] [data-index="${boxes[2]}"]`).dragTo(page.locator('[data-group="Group"]'));
    await page.waitForFunction(() => document.querySelector('[data-group="Group"] .row-kind')?.textContent === "3");
    await picture("groups");
    await page.getByTestId("canvas").focus();
    await page.keyboard.press("Control+a");
    await page.keyboard.press("Control+Shift+g");
    await page.waitForFunction(() => !document.querySelector("[data-testid=hierarchy] [data-group]"));
  });

  it("finds models like one of the browser", async () => {
    await searchFor(page, "chair");
    const tile = page.getByTestId("model-tile").first();
    const key = await tile.getAttribute("data-key");
    await tile.click({ button: "right" });
    await page.getByTestId("menu.like").click();
    await page.waitForFunction(() => /like/.test(document.querySelector("[data-testid=result-count]").textContent));
    assert.equal(await page.getByTestId("model-tile").first().getAttribute("data-key"), key);
    const { models } = await session.command("catalog.search", { words: "", limit: 1000 });
    const category = (key) => models.find((model) => model.key === key).category;
    const alike = await page.getByTestId("model-tile").evaluateAll((tiles) => tiles.map((tile) => tile.dataset.key));
    assert.ok(alike.length > 3 && alike.every((other) => category(other) === category(key)));
  });

  it("turns the camera by a drag on a wall or on nothing", async () => {
    const count = await page.evaluate(() => window.embody.frames());
    const wall = await project(0, 2.2, WALL);
    const before = await project(0, 0, 0);
    await drag(wall, { x: wall.x + 80, y: wall.y });
    const after = await project(0, 0, 0);
    assert.ok(Math.hypot(after.x - before.x, after.y - before.y) > 5, "the view has turned");
    await page.waitForFunction((count) => window.embody.frames() > count, count);
    const { scene } = await session.command("hello");
    assert.deepEqual(scene.entities[1].pose.position, ROOM.entities[1].pose.position, "the wall has not moved");
    assert.deepEqual(page.faults, []);
  });
});
