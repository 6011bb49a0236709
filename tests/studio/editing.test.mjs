// SPDX-License-Identifier: MIT
// Several things edited at once, values that can be read and typed again, and locks: the real server, a real browser.
import assert from "node:assert/strict";
import { after, afterEach, before, beforeEach, describe, it } from "node:test";
import { allDone, Session, until as untilFits } from "./session.mjs";

const FLOOR = { index: 1, name: "Floor", shape: { type: "box", half_extents: [10, 0.1, 10] }, pose: { position: [0, -0.1, 0] }, attributes: { kind: "static" } };
const turned = (degrees) => [0, Math.sin((degrees * Math.PI) / 360), 0, Math.cos((degrees * Math.PI) / 360)];
const THREE = [2, 3, 4];
const ROOM = {
  embody_scene: 1,
  title: "Three things",
  entities: [
    FLOOR,
    { index: 2, name: "Box", shape: { type: "box", half_extents: [0.2, 0.2, 0.2] }, pose: { position: [-1, 0.5, 0.25], rotation: turned(10) }, linear_velocity: [1, 0, 0.5], force: [2, 0, 0] },
    { index: 3, name: "Ball", shape: { type: "sphere", radius: 0.2 }, pose: { position: [0, 0.5, -0.125], rotation: turned(20) }, linear_velocity: [2, 0, 0.5], force: [3, 0, 0] },
    { index: 4, name: "Can", shape: { type: "cylinder", radius: 0.2, half_height: 0.2 }, pose: { position: [1, 0.75, 0.5], rotation: turned(30) } },
  ],
  camera: { position: [3, 2.4, 4], target: [0, 0.4, 0] },
};

describe("edits of several things in the Studio", { timeout: 900000 }, () => {
  const session = new Session();
  let page;

  before(() => session.start(ROOM));
  after(() => session.end());
  beforeEach(async () => {
    page = await session.reopen();
    await session.command("scene.load", { scene: ROOM });
    await page.waitForFunction((count) => window.embody.entities().filter((entity) => entity.drawn).length === count, ROOM.entities.length);
    await page.getByTestId("tab-In the scene").click();
  });
  afterEach(() => assert.deepEqual(page.faults, []));

  const row = (index) => page.locator(`[data-testid=hierarchy] [data-index="${index}"]`);
  async function choose(...indices) {
    for (const [at, index] of indices.entries()) await row(index).click(at > 0 ? { modifiers: ["Control"] } : {});
    // Until their values have come, those of the first one alone are shown.
    await allDone(page);
  }
  const scene = async () => (await session.command("hello")).scene;
  const entity = async (index) => (await scene()).entities.find((each) => each.index === index);
  const position = (of) => of.pose?.position ?? [0, 0, 0];
  const label = (name) => page.getByLabel(name, { exact: true });
  async function type(name, text) {
    await label(name).fill(text);
    await label(name).press("Enter");
  }
  // What the document has once a check holds; the page and the server hear of an edit one after the other.
  const until = (check, message) => untilFits(async () => (await scene()).entities, check, message);
  const three = (entities) => THREE.map((index) => entities.find((each) => each.index === index));
  const near = (a, b) => Math.abs(a - b) < 1e-6;

  it("moves all to the typed height and leaves x and z to each", async () => {
    await choose(...THREE);
    assert.equal(await label("Position x").getAttribute("placeholder"), "differs");
    assert.equal(await label("Position y").inputValue(), "");
    await type("Position y", "1.25");
    const moved = three(await until((all) => three(all).every((each) => near(position(each)[1], 1.25)), "y of all"));
    moved.forEach((each, at) => {
      const was = ROOM.entities[at + 1].pose.position;
      assert.deepEqual([position(each)[0], position(each)[2]], [was[0], was[2]], each.name);
    });
    // What all agree in is shown.
    await page.waitForFunction(() => document.querySelector("[aria-label='Position y']").value === "1.25");
    await page.keyboard.press("Escape");
    await page.getByTestId("canvas").focus();
    await page.keyboard.press("Control+z");
    await until((all) => near(position(three(all)[2])[1], 0.75), "one undo takes all back");
  });

  it("turns all about one axis by degrees and keeps the turn of each about the others", async () => {
    await choose(...THREE);
    await type("Rotation x", "40");
    const yaws = (all) => three(all).map(({ pose: { rotation: [x, y, z, w] } }) => (Math.atan2(2 * (x * z + w * y), 1 - 2 * (x * x + y * y)) * 180) / Math.PI);
    const pitch = ({ pose: { rotation: [x, y, z, w] } }) => (Math.asin(2 * (w * x - y * z)) * 180) / Math.PI;
    const turnedAll = await until((all) => three(all).every((each) => Math.abs(pitch(each) - 40) < 1e-4), "40 degrees about x");
    yaws(turnedAll).forEach((yaw, at) => assert.ok(Math.abs(yaw - 10 * (at + 1)) < 1e-4, `${yaw} degrees about y`));
  });

  it("changes one component of velocity and force of each", async () => {
    await choose(...THREE);
    await page.getByText("Start and forces").click();
    await type("Velocity y", "3");
    await type("Force z", "-4");
    const all = three(await until((each) => three(each).every(({ force }) => force?.[2] === -4), "the force of all"));
    assert.deepEqual(all.map(({ linear_velocity }) => linear_velocity), [[1, 3, 0.5], [2, 3, 0.5], [0, 3, 0]]);
    assert.deepEqual(all.map(({ force }) => force), [[2, 0, -4], [3, 0, -4], [0, 0, -4]]);
  });

  it("changes one component of the centre of mass of each", async () => {
    await session.command("entity.set_attribute", { indices: [2], name: "center_of_mass", value: [0.05, 0, 0.01] });
    await choose(...THREE);
    await page.getByTestId("attribute-center_of_mass").waitFor({ state: "attached" });
    await page.evaluate(() => document.querySelectorAll("details").forEach((each) => (each.open = true)));
    await page.waitForFunction(() => document.querySelector("[data-testid=attribute-center_of_mass] input").placeholder === "differs");
    await type("Centre of mass y", "0.02");
    const all = three(await until((each) => three(each).every(({ attributes }) => attributes?.center_of_mass?.[1] === 0.02), "y of all centres"));
    assert.deepEqual(all[0].attributes.center_of_mass, [0.05, 0.02, 0.01]);
    assert.deepEqual(all[1].attributes.center_of_mass.map((part) => Math.round(part * 1e9) / 1e9), [0, 0.02, 0]);
  });

  it("shows never, all and groups, and reads them again", async () => {
    await choose(2);
    const field = (name) => page.locator(`[data-testid=attribute-${name}] input`).first();
    await field("break_impulse").waitFor({ state: "attached" });
    // Groups that are closed at first are opened.
    await page.evaluate(() => document.querySelectorAll("details").forEach((each) => (each.open = true)));
    assert.equal(await field("break_impulse").inputValue(), "never");
    assert.equal(await field("collision_mask").inputValue(), "all");
    assert.equal(await field("collision_group").inputValue(), "1");
    const set = async (name, typed, shown, value) => {
      await field(name).fill(typed);
      await field(name).press("Enter");
      await until((all) => JSON.stringify(all.find(({ index }) => index === 2).attributes?.[name]) === JSON.stringify(value), `${name} ${typed}`);
      await page.waitForFunction(([name, shown]) => document.querySelector(`[data-testid=attribute-${name}] input`).value === shown, [name, shown]);
    };
    await set("break_impulse", "50", "50", 50);
    await set("break_impulse", "never", "never", "infinity");
    await set("collision_mask", "1, 3", "1, 3", 5);
    await set("collision_mask", "all but 2", "all but 2", 4294967293);
    await set("collision_mask", "all", "all", 4294967295);
    await field("collision_mask").fill("33");
    await field("collision_mask").press("Enter");
    await page.getByText("Type groups from 1 to 32").waitFor();
  });

  it("shows no value that cannot be read, of any kind of thing", async () => {
    const kinds = ["rigid", "static", "soft", "cloth", "rope", "granular", "fluid"];
    const half = { cloth: [0.2, 0.005, 0.2] };
    const made = kinds.map((kind, at) => ({ index: 10 + at, name: kind, shape: { type: "box", half_extents: half[kind] ?? [0.2, 0.2, 0.2] }, pose: { position: [1.5 * at, 2, 0] }, attributes: { kind } }));
    const shapes = { capsule: { radius: 0.1, half_height: 0.2 }, cone: { radius: 0.2, half_height: 0.2 }, plane: { normal: [0, 1, 0], offset: -3 } };
    const primitives = Object.entries(shapes).map(([type, lengths], at) => ({ index: 20 + at, name: type, shape: { type, ...lengths }, pose: { position: [1.5 * at, 4, 0] }, ...(type === "plane" && { attributes: { kind: "static" } }) }));
    const { models } = await session.command("catalog.search", { words: "chair", limit: 1 });
    const all = { ...ROOM, title: "All kinds", entities: [...ROOM.entities, ...made, ...primitives, { index: 30, model: models[0].key, pose: { position: [0, 0, 3] } }] };
    await session.command("scene.load", { scene: all });
    await page.waitForFunction((count) => window.embody.entities().length === count, all.entities.length);
    const expected = { static: 15, rigid: 20, soft: 15, cloth: 15, rope: 15, granular: 15, fluid: 15, chair: 20, capsule: 20, cone: 20, plane: 8 };
    for (const { index, name = "chair" } of [...made, ...primitives, ...ROOM.entities.slice(1).map((each) => ({ ...each, name: "rigid" })), { index: 30 }]) {
      await choose(index);
      await page.waitForFunction(([index, least]) => window.embody.selection()[0] === index && document.querySelectorAll(":is([data-testid=essentials], [data-testid=attributes]) .attribute").length >= least, [index, expected[name]]);
      await page.evaluate(() => document.querySelectorAll("details").forEach((each) => (each.open = true)));
      const unreadable = await page.evaluate(() =>
        [...document.querySelectorAll("[data-testid=properties] input:not([type=checkbox], [type=color])")]
          .filter((input) => input.checkVisibility())
          .map((input) => [input.getAttribute("aria-label"), input.value])
          .filter(([, value]) => /\?|NaN|undefined|null|∞|infinity|_|\d{11}|e[+-]?\d/.test(value)),
      );
      assert.deepEqual(unreadable, [], name);
      // Six boxes without names were six riddles.
      if (name === "rigid") assert.deepEqual(await page.locator("[data-testid=attribute-inertia] .mark").allInnerTexts(), ["xx", "yy", "zz", "xy", "xz", "yz"]);
    }
  });

  it("locks with key and padlock, and leaves locked things out of everything", async () => {
    await choose(1);
    await page.getByTestId("canvas").focus();
    await page.keyboard.press("l");
    await until((all) => all[0].locked === true, "the floor is locked");
    await page.waitForFunction(() => document.querySelector("[data-testid=lock-1]").getAttribute("aria-pressed") === "true");
    assert.equal(await page.getByTestId("entity-lock").getAttribute("aria-label"), "Unlock");

    // The handles do not attach: a drag from its middle turns the camera.
    await page.keyboard.press("w");
    const canvas = await page.getByTestId("canvas").boundingBox();
    const at = { x: canvas.x + canvas.width * 0.5, y: canvas.y + canvas.height * 0.85 };
    assert.equal(await page.evaluate(({ x, y }) => window.embody.pick(x, y), at), 1);
    const seen = await page.evaluate(() => window.embody.camera());
    await page.mouse.move(at.x, at.y);
    await page.mouse.down();
    await page.mouse.move(at.x + 80, at.y, { steps: 5 });
    await page.mouse.up();
    assert.notDeepEqual((await page.evaluate(() => window.embody.camera())).position, seen.position, "the camera turned");
    assert.deepEqual(position(await entity(1)), FLOOR.pose.position);
    await page.mouse.click(at.x, at.y);
    assert.deepEqual(await page.evaluate(() => window.embody.selection()), [1], "a click selects it still");

    await page.keyboard.press("Control+a");
    assert.deepEqual(await page.evaluate(() => window.embody.selection()), THREE);
    await page.keyboard.press("Escape");
    await page.keyboard.down("Control");
    await page.mouse.move(canvas.x + 5, canvas.y + 5);
    await page.mouse.down();
    await page.mouse.move(canvas.x + canvas.width - 5, canvas.y + canvas.height - 5, { steps: 4 });
    await page.mouse.up();
    await page.keyboard.up("Control");
    assert.ok(!(await page.evaluate(() => window.embody.selection())).includes(1), "the rectangle");

    await choose(1, 2);
    await page.getByTestId("canvas").focus();
    await page.keyboard.press("Delete");
    await page.getByText("Floor is locked and stayed").waitFor();
    await until((all) => all.length === ROOM.entities.length - 1 && all.some(({ index }) => index === 1), "the box is gone, the floor stays");
    await page.getByTestId("toast-action").click();
    await until((all) => !all.find(({ index }) => index === 1).locked, "unlocked by the message");
    await page.getByTestId("lock-3").focus();
    await page.keyboard.press("Enter");
    await until((all) => all.find(({ index }) => index === 3).locked, "locked by the padlock of the list");
    // The keyboard stays there.
    await page.waitForFunction(() => document.activeElement.dataset.testid === "lock-3" && document.activeElement.getAttribute("aria-pressed") === "true");
  });

  it("does not move what is locked by numbers, and says so", async () => {
    await session.command("entity.lock", { indices: [2], locked: true });
    await choose(...THREE);
    await type("Position y", "2");
    await page.getByText("Box is locked and stayed").waitFor();
    const all = three(await until((each) => near(position(three(each)[1])[1], 2), "the ball moved"));
    assert.equal(position(all[0])[1], 0.5);
    assert.equal(position(all[2])[1], 2);
  });
});
