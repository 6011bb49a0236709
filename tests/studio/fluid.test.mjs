// SPDX-License-Identifier: MIT
// Liquids in the Studio: drawn as one surface, flowing apart, selected, changed, and offered as primitives.
import assert from "node:assert/strict";
import { after, before, beforeEach, describe, it } from "node:test";
import { atRest, difference, openStudio, pictureOfScene } from "./browser.mjs";
import { Session, settled } from "./session.mjs";

const WATER = 2;
const SCENE = {
  embody_scene: 1,
  title: "Water",
  entities: [
    { index: 1, name: "Floor", shape: { type: "plane", normal: [0, 1, 0], offset: 0 }, attributes: { kind: "static" } },
    {
      index: WATER,
      name: "Water",
      shape: { type: "box", half_extents: [0.1, 0.1, 0.1] },
      pose: { position: [0, 0.101, 0] },
      attributes: { kind: "fluid", particle_budget: 2000 },
    },
  ],
  camera: { position: [0.5, 0.4, 0.7], target: [0, 0.08, 0] },
};

describe("liquids in the Studio", { timeout: 600000 }, () => {
  const session = new Session();
  let page;

  before(() => session.start(SCENE));
  after(() => session.end());
  beforeEach(async () => {
    page = await session.reopen();
    await command("scene.load", { scene: SCENE });
    await surface();
  });

  const command = (name, params) => session.command(name, params);
  // The worker makes the surface, so it arrives some time after the points.
  async function surface(of = page) {
    await of.waitForFunction((water) => window.embody.points(water)?.triangles > 100 && window.embody.points(water).settled, WATER);
    return of.evaluate((water) => window.embody.points(water), WATER);
  }

  it("draws one surface that runs apart, and is as it was after a reset", async () => {
    const filled = await surface();
    assert.equal(filled.liquid, true);
    assert.ok(filled.count > 1000 && filled.count <= 2000, `${filled.count} drops of a budget of 2000`);
    assert.ok(filled.upper[0] < 0.12 && filled.lower[1] > -0.01, JSON.stringify(filled));
    await command("simulation.step", { count: 40 });
    await page.waitForFunction((water) => window.embody.points(water).upper[0] > 0.2, WATER);
    await command("simulation.reset", {});
    await page.waitForFunction((upper) => window.embody.points(2).upper[0] === upper, filled.upper[0]);
    assert.deepEqual(page.faults, []);
  });

  it("is selected by a click on its surface, and shows its resolution and the reason", async () => {
    const seen = await page.evaluate((water) => window.embody.seenAt(water), WATER);
    await page.mouse.click(seen.x, seen.y);
    assert.deepEqual(await page.evaluate(() => window.embody.selection()), [WATER]);
    const row = page.locator("[data-testid=attribute-fluid_cell_size]").first();
    await row.waitFor({ state: "attached" });
    assert.match(await row.locator(".source").textContent(), /particles, eight in a cell/);
    assert.deepEqual(page.faults, []);
  });

  it("is drawn as before after it was selected and deselected", async () => {
    const seen = await page.evaluate((index) => window.embody.seenAt(index), WATER);
    await page.mouse.click(seen.x, seen.y);
    await page.waitForFunction((index) => window.embody.selection()[0] === index, WATER);
    await atRest(page);
    await page.keyboard.press("Escape");
    await page.waitForFunction(() => window.embody.selection().length === 0);
    await atRest(page);
    await command("simulation.step", { count: 20 });
    await page.waitForFunction((water) => window.embody.points(water).upper[0] > 0.13, WATER);
    await surface();
    const drawn = await pictureOfScene(page);
    // Another page that connects now sees the same.
    const other = await openStudio(session.browser, session.address);
    await surface(other);
    const share = await difference(page, drawn, await pictureOfScene(other));
    await other.context().close();
    assert.ok(share < 0.002, `${share} of the pixels differ`);
    assert.deepEqual(page.faults, []);
  });

  it("becomes a solid thing and water again while it runs", async () => {
    await command("simulation.step", { count: 5 });
    await command("entity.set_attribute", { indices: [WATER], name: "kind", value: "rigid" });
    await page.waitForFunction((water) => !window.embody.points(water), WATER);
    await command("entity.set_attribute", { indices: [WATER], name: "kind", value: "fluid" });
    await surface();
    // By hand: undo takes back what its own person did.
    await page.getByTestId("tab-In the scene").click();
    await page.locator(`[data-testid=hierarchy] [data-index="${WATER}"]`).click();
    await page.getByTestId("canvas").focus();
    await page.keyboard.press("Delete");
    await page.waitForFunction((water) => !window.embody.points(water), WATER);
    await page.keyboard.press("Control+z");
    await surface();
    assert.deepEqual(page.faults, []);
  });

  it("can be added as a primitive", async () => {
    await page.locator("[data-testid=primitive-water]").dblclick();
    await page.waitForFunction(() => window.embody.entities().length === 3);
    await page.waitForFunction(() => window.embody.points(3)?.liquid === true && window.embody.points(3).triangles > 100);
    assert.deepEqual(page.faults, []);
  });

  it("comes from a tap and goes into a drain that are placed, changed and taken back by hand", async () => {
    await command("scene.load", { scene: { ...SCENE, entities: SCENE.entities.slice(0, 1) } });
    await page.waitForFunction(() => window.embody.entities().length === 1);
    const named = (name) => page.waitForFunction((name) => window.embody.entities().find((each) => each.name === name)?.index, name).then((found) => found.jsonValue());
    // A tap brings the water that it is to give, which has no drop yet.
    await page.getByTestId("primitive-tap").dblclick();
    const tap = await named("Tap");
    const pool = await named("Water");
    await page.waitForFunction((pool) => window.embody.points(pool)?.count === 0, pool);
    await page.waitForFunction((tap) => window.embody.selection()[0] === tap && window.embody.portMarks().lines > 0, tap);
    // The arrow goes down from the mouth, 5 cm above the tap's middle and 15 cm before it.
    const [mark, tapAt] = await page.evaluate((tap) => [window.embody.portMarks(), window.embody.entities().find(({ index }) => index === tap).position], tap);
    const offsets = [mark.lower, mark.upper].map((corner) => corner.map((x, axis) => x - tapAt[axis]));
    for (const [corner, wanted] of [[0, [-0.016, -0.03, 0.134]], [1, [0.016, 0.05, 0.166]]])
      offsets[corner].forEach((x, axis) => assert.ok(Math.abs(x - wanted[axis]) < 1e-3, JSON.stringify(offsets)));
    const fields = page.getByTestId("port-fields");
    const flow = fields.getByLabel("Flow, l/min");
    assert.equal(await flow.inputValue(), "30");
    await flow.fill("240");
    await flow.press("Enter");
    await fields.getByLabel("Radius of the mouth, m").fill("0.03");
    await fields.getByLabel("Radius of the mouth, m").press("Enter");
    await settled(page);
    // What is to come is framed and marked where it is to come, and not at the middle of the world.
    await page.getByTestId("tab-In the scene").click();
    await page.locator(`[data-testid=hierarchy] [data-index="${pool}"]`).click();
    await page.waitForFunction(() => window.embody.portMarks().lines === 12);
    const at = await page.evaluate((pool) => window.embody.seenAt(pool), pool);
    const place = (await page.evaluate(() => window.embody.entities())).find(({ index }) => index === pool).position;
    const wanted = await page.evaluate(([x, y, z]) => window.embody.project(x, y, z), place);
    assert.ok(Math.hypot(at.x - wanted.x, at.y - wanted.y) < 2, JSON.stringify({ at, wanted }));
    const count = () => page.evaluate((pool) => window.embody.points(pool).count, pool);
    await command("simulation.step", { count: 60 });
    await page.waitForFunction((pool) => window.embody.points(pool).count > 0 && window.embody.points(pool).triangles > 0, pool);
    await page.waitForFunction(() => window.embody.portMarks().lines === 0);
    // Shut, nothing comes; undo opens it again.
    await page.locator(`[data-testid=hierarchy] [data-index="${tap}"]`).click();
    await page.waitForFunction((tap) => window.embody.selection()[0] === tap, tap);
    await fields.getByLabel("Tap open").uncheck();
    await settled(page);
    const shut = await count();
    await command("simulation.step", { count: 30 });
    assert.equal(await count(), shut);
    await page.getByTestId("canvas").focus();
    await page.keyboard.press("Control+z");
    await page.waitForFunction(() => document.querySelector("[data-testid=port-fields] [aria-label='Tap open']").checked);
    await command("simulation.step", { count: 30 });
    await page.waitForFunction(({ pool, shut }) => window.embody.points(pool).count > shut, { pool, shut });
    await command("simulation.reset", {});
    await page.waitForFunction((pool) => window.embody.points(pool).count === 0, pool);
    // A drain has a mark, too; undo takes all of it back, the water along with its tap.
    await page.getByTestId("tab-Models").click();
    await page.getByTestId("primitive-drain").dblclick();
    const drain = await named("Drain");
    await page.waitForFunction((drain) => window.embody.selection()[0] === drain && window.embody.portMarks().lines === 72, drain);
    assert.equal(await fields.getByLabel("Radius of the drain, m").inputValue(), "0.045");
    await page.getByTestId("canvas").focus();
    for (const left of [3, 3, 3, 1]) {
      await page.keyboard.press("Control+z");
      await page.waitForFunction((left) => window.embody.entities().length === left, left);
      await settled(page);
    }
    assert.deepEqual(page.faults, []);
  });

  it("draws its drops, and says why, where surfaces cannot be made", async () => {
    const prepare = (page) =>
      page.route("**/liquid_worker*", (route) => route.fulfill({ contentType: "text/javascript", body: "throw new Error('out of order');" }));
    page = await session.reopen({ prepare });
    await page.waitForFunction((water) => window.embody.points(water)?.liquid === false && window.embody.points(water).count > 100, WATER);
    await page.getByText(/surfaces of liquids cannot be drawn: .*out of order/).waitFor();
    const seen = await page.evaluate((water) => window.embody.seenAt(water), WATER);
    assert.equal(await page.evaluate(({ x, y }) => window.embody.pick(x, y), seen), WATER);
    // They are drawn as drops from now on, also liquids that are added later.
    await command("simulation.step", { count: 40 });
    await page.waitForFunction((water) => window.embody.points(water).upper[0] > 0.2, WATER);
    await page.locator("[data-testid=primitive-water]").dblclick();
    await page.waitForFunction(() => window.embody.points(3)?.liquid === false);
    assert.ok(page.faults.every((fault) => fault.includes("out of order")), `${page.faults}`);
  });
});
