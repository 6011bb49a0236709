// SPDX-License-Identifier: MIT
// The Studio as a user sees it: the real server, the real furniture catalogue, a real browser.
import assert from "node:assert/strict";
import { after, before, beforeEach, describe, it } from "node:test";
import { allDone, searchFor as searchOn, Session } from "./session.mjs";

const ASLEEP = 2;
const FLOOR = { name: "Floor", shape: { type: "plane", normal: [0, 1, 0], offset: 0 }, attributes: { kind: "static" } };
const EMPTY_ROOM = {
  embody_scene: 1,
  title: "Empty room",
  entities: [FLOOR],
  camera: { position: [3, 2.4, 4], target: [0, 0.4, 0] },
};

describe("the Studio on the real catalogue", { timeout: 900000 }, () => {
  const session = new Session();
  let page;

  before(() => session.start(EMPTY_ROOM));
  after(() => session.end());
  beforeEach(async () => {
    page = await session.reopen();
    await load(EMPTY_ROOM);
  });

  // Opens a scene as another client of the same server would.
  async function load(scene) {
    await session.command("scene.load", { scene });
    await page.waitForFunction((title) => document.title.includes(title), scene.title);
    await page.waitForFunction((count) => window.embody.entities().filter((entity) => entity.drawn).length === count, scene.entities.length);
  }

  const entities = () => page.evaluate(() => window.embody.entities());
  const newest = async () => (await entities()).at(-1);
  const field = (name) => page.locator(`[data-testid=attribute-${name}] input`).first();
  const chosen = () => page.evaluate(() => window.embody.selection());

  async function dragIn(source, to = { x: 0.5, y: 0.6 }) {
    const before = (await entities()).length;
    const canvas = await page.getByTestId("canvas").boundingBox();
    const from = await source.boundingBox();
    await page.mouse.move(from.x + from.width / 2, from.y + from.height / 2);
    await page.mouse.down();
    await page.mouse.move(from.x + 40, from.y + 10, { steps: 3 });
    await page.mouse.move(canvas.x + canvas.width * to.x, canvas.y + canvas.height * to.y, { steps: 5 });
    await page.mouse.up();
    await page.waitForFunction((count) => window.embody.entities().length > count, before);
    await page.waitForFunction(() => window.embody.entities().at(-1).drawn, null, { timeout: 30000 });
    // It is selected when the answer has come, after the event that draws it; then its values are asked for.
    await page.waitForFunction(() => window.embody.selection().length === 1 && window.embody.selection()[0] === window.embody.entities().at(-1).index);
    await allDone(page);
    return newest();
  }

  const searchFor = (words) => searchOn(page, words);
  // Places are told in full by the document and with fewer digits by frames.
  const near = (a, b) => assert.ok(Math.hypot(...a.map((each, axis) => each - b[axis])) < 1e-5, `${a} is not ${b}`);

  it("finds a chair, drops it in, plays, and sees it come to rest on the floor in gray", async () => {
    const all = Number((await page.getByTestId("result-count").innerText()).replace(/\D/g, ""));
    assert.ok(all > 500, `the real catalogue has ${all} models`);
    await searchFor("chair");
    const found = Number((await page.getByTestId("result-count").innerText()).replace(/\D/g, ""));
    assert.ok(found > 3 && found < all, `${found} chairs`);

    const chair = await dragIn(page.getByTestId("model-tile").first());
    assert.ok(chair.model, "the entity names its model");
    assert.deepEqual(await chosen(), [chair.index]);
    // The chair stands on the floor where it was dropped; lift it, so that it falls. From 0.5 m every second chair bounces from leg
    // to leg and topples, by the restitution of its wood.
    await page.getByLabel("Position y").fill("0.15");
    await page.getByLabel("Position y").press("Enter");
    await page.waitForFunction(() => Math.abs(window.embody.entities().at(-1).position[1] - 0.15) < 0.01);

    // It moves for a short time: the look for that begins before.
    await Promise.all([page.waitForFunction(() => window.embody.entities().at(-1).state === 0 && window.embody.simulation().state === "playing"), page.getByTestId("simulation.play").click()]);
    await page.waitForFunction((asleep) => window.embody.entities().at(-1).state === asleep, ASLEEP, { timeout: 60000 });
    const resting = await newest();
    assert.ok(Math.abs(resting.position[1]) < 0.02, `the chair's base rests at ${resting.position[1]} m`);
    const rotation = resting.rotation.map((part) => Math.abs(part));
    assert.ok(Math.abs(rotation[3] - 1) < 0.2 || rotation[1] > 0.5, "it stands upright");

    // Gray in the picture: red, green and blue of the chair's pixels are nearly equal.
    await page.waitForFunction(() => document.querySelector("[data-testid=stat-asleep]").textContent.startsWith("1 "));
    assert.ok(await page.getByTestId("legend").isVisible());
    // The state is known before the picture that shows it.
    await page.waitForFunction(() => {
      const [red, green, blue, amount] = window.embody.tintOf(window.embody.entities().at(-1).index);
      return amount > 0 && Math.max(red, green, blue) - Math.min(red, green, blue) < 0.1;
    });
    assert.deepEqual(page.faults, []);
  });

  it("deletes, brings back and deletes again", async () => {
    const box = await dragIn(page.getByTestId("primitive-box"));
    const at = await page.evaluate((index) => window.embody.seenAt(index), box.index);
    await page.keyboard.press("Escape");
    await page.mouse.click(at.x, at.y);
    assert.deepEqual(await chosen(), [box.index]);
    await page.keyboard.press("Delete");
    await page.waitForFunction(() => window.embody.entities().length === 1);
    await page.getByTestId("edit.undo").click();
    await page.waitForFunction(() => window.embody.entities().length === 2);
    near((await newest()).position, box.position);
    await page.keyboard.press("Control+Shift+Z");
    await page.waitForFunction(() => window.embody.entities().length === 1);
  });

  it("edits the mass with its reason shown, refuses nonsense, and goes back to the automatic value", async () => {
    await searchFor("chair");
    await dragIn(page.getByTestId("model-tile").first());
    const row = page.getByTestId("attribute-mass");
    await row.waitFor();
    const automatic = await field("mass").inputValue();
    assert.ok(Number(automatic) > 0.2 && Number(automatic) < 100, `${automatic} kg`);
    assert.match(await row.innerText(), /kg/);
    await page.getByTestId("why-mass").click();
    assert.ok((await row.locator(".source").innerText()).length > 10, "says where the value is from");
    for (const part of [0, 1, 2]) {
      const moment = await page.locator("[data-testid=attribute-inertia] input").nth(part).inputValue();
      assert.ok(Number(moment) > 0, `a chair resists turning about each axis: ${moment} kg m²`);
    }

    await field("mass").fill("-1");
    await field("mass").press("Enter");
    await row.locator(".field-error").waitFor();
    await field("mass").fill("12.5");
    await field("mass").press("Enter");
    await row.getByLabel("manual").waitFor();
    assert.equal(await row.locator(".field-error").count(), 0);
    await page.getByTestId("reset-mass").click();
    await page.getByTestId("reset-mass").waitFor({ state: "hidden" });
    assert.equal(await field("mass").inputValue(), automatic);
  });

  it("saves under a name, opens it again, and keeps what was made", async () => {
    const ball = await dragIn(page.getByTestId("primitive-sphere"));
    await page.keyboard.press("Control+s");
    await page.getByTestId("save-name").fill("kept by a test");
    // The message goes by itself.
    await Promise.all([page.getByText("Saved “kept by a test”").waitFor(), page.keyboard.press("Enter")]);
    await page.waitForFunction(() => !document.title.startsWith("•"));
    await page.getByTestId("scene.new").click();
    await page.waitForFunction((index) => !window.embody.entities().some((entity) => entity.index === index), ball.index);
    await page.getByTestId("scene.open").click();
    await page.getByTestId("scene-kept by a test").click();
    await page.waitForFunction(() => window.embody.entities().length === 2);
    near((await newest()).position, ball.position);
  });

  it("counts bodies, steps one step at a time and goes back to the start", async () => {
    const ball = await dragIn(page.getByTestId("primitive-sphere"));
    await page.getByLabel("Position y").fill("2");
    await page.getByLabel("Position y").press("Enter");
    await page.waitForFunction(() => window.embody.entities().at(-1).position[1] > 1.9);
    await page.keyboard.press("Escape");
    await page.getByTestId("canvas").focus();
    for (let step = 1; step <= 3; ++step) {
      await page.keyboard.press(".");
      await page.waitForFunction((step) => window.embody.simulation().step === step, step);
    }
    await page.waitForFunction(() => window.embody.entities().at(-1).position[1] < 1.999);
    assert.match(await page.getByTestId("stat-state").innerText(), /Paused/);
    await page.keyboard.press("Space");
    await page.waitForFunction(() => /^\d of 1 active$/.test(document.querySelector("[data-testid=stat-active]").textContent));
    await page.getByTestId("simulation.reset").click();
    await page.waitForFunction(() => window.embody.simulation().state === "stopped");
    await page.waitForFunction((height) => Math.abs(window.embody.entities().at(-1).position[1] - height) < 1e-3, 2);
    assert.equal((await newest()).index, ball.index);
  });

  it("keeps the poses things settled in, and undo takes that back", async () => {
    await dragIn(page.getByTestId("primitive-box"));
    await page.getByLabel("Position y").fill("1");
    await page.getByLabel("Position y").press("Enter");
    await page.waitForFunction(() => window.embody.entities().at(-1).position[1] > 0.9);
    await page.getByTestId("simulation.play").click();
    await page.waitForFunction((asleep) => window.embody.entities().at(-1).state === asleep, ASLEEP, { timeout: 60000 });
    await page.getByTestId("simulation.keep").click();
    await page.waitForFunction(() => window.embody.simulation().state === "stopped");
    await page.waitForFunction(() => Math.abs(window.embody.entities().at(-1).position[1] - 0.2) < 0.01);
    await page.getByTestId("edit.undo").click();
    await page.waitForFunction(() => Math.abs(window.embody.entities().at(-1).position[1] - 1) < 0.01);
  });

  it("pulls a body with the mouse while the scene plays", async () => {
    const box = await dragIn(page.getByTestId("primitive-box"));
    // A hand is as strong as an arm: it lifts no solid box of 125 kg.
    await session.command("entity.set_attribute", { indices: [box.index], name: "mass", value: 5 });
    await page.getByTestId("simulation.play").click();
    await page.waitForFunction(() => window.embody.simulation().state === "playing");
    const at = await page.evaluate((index) => window.embody.seenAt(index), box.index);
    await page.mouse.move(at.x, at.y);
    await page.mouse.down();
    for (let step = 1; step <= 10; ++step) await page.mouse.move(at.x + 4 * step, at.y - 15 * step);
    await page.waitForFunction((height) => window.embody.entities().at(-1).position[1] > height + 0.2, box.position[1]);
    await page.mouse.up();
    await page.waitForFunction((asleep) => window.embody.entities().at(-1).state === asleep, ASLEEP, { timeout: 60000 });
  });

  it("imports a file dropped from the desktop and adds it where it was dropped", async () => {
    const file = "solid tetra\n" + [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]]
      .map((face) => `facet normal 0 0 0\nouter loop\n${face.map((at) => `vertex ${[[0, 0, 0], [1, 0, 0], [0, 0, 1], [0, 1, 0]][at].join(" ")}`).join("\n")}\nendloop\nendfacet`)
      .join("\n") + "\nendsolid\n";
    await page.evaluate((text) => {
      const canvas = document.querySelector("canvas").getBoundingClientRect();
      const data = new DataTransfer();
      data.items.add(new File([text], "tetra.stl"));
      const place = { clientX: canvas.left + canvas.width / 2, clientY: canvas.top + canvas.height * 0.6, bubbles: true, cancelable: true };
      document.querySelector("canvas").dispatchEvent(new DragEvent("drop", { dataTransfer: data, ...place }));
    }, file);
    await page.waitForFunction(() => window.embody.entities().some((entity) => entity.model && entity.drawn), null, { timeout: 60000 });
  });

  it("says that the server is gone, and goes on when it is back", async () => {
    await session.server.stop();
    await page.getByTestId("connection-lost").waitFor();
    await session.server.start(EMPTY_ROOM);
    await page.getByTestId("connection-lost").waitFor({ state: "hidden", timeout: 30000 });
    // The page was connected before: the answer to its greeting counts.
    await allDone(page);
    await page.waitForFunction((title) => document.title.includes(title) && window.embody.loading() === 0, EMPTY_ROOM.title, { timeout: 60000 });
  });
});
