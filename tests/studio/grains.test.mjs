// SPDX-License-Identifier: MIT
// Grains in the Studio: drawn as points, poured, selected, changed, and seen by pages that connect later.
import assert from "node:assert/strict";
import { after, before, beforeEach, describe, it } from "node:test";
import { openStudio } from "./browser.mjs";
import { Session } from "./session.mjs";

const ASLEEP = 2;
const SAND = 2;
const SANDBOX = {
  embody_scene: 1,
  title: "Sandbox",
  entities: [
    { index: 1, name: "Floor", shape: { type: "plane", normal: [0, 1, 0], offset: 0 }, attributes: { kind: "static" } },
    {
      index: SAND,
      name: "Sand",
      shape: { type: "cylinder", radius: 0.1, half_height: 0.1 },
      pose: { position: [0, 0.101, 0] },
      attributes: { kind: "granular", grain_budget: 600 },
    },
  ],
  camera: { position: [0.5, 0.4, 0.7], target: [0, 0.08, 0] },
};

describe("grains in the Studio", { timeout: 600000 }, () => {
  const session = new Session();
  let page;

  before(() => session.start(SANDBOX));
  after(() => session.end());
  beforeEach(async () => {
    page = await session.reopen();
    await command("scene.load", { scene: SANDBOX });
    await page.waitForFunction((sand) => window.embody.points(sand), SAND);
  });

  const command = (name, params) => session.command(name, params);
  const points = (from = page) => from.evaluate((sand) => window.embody.points(sand), SAND);
  const state = () => page.evaluate((sand) => window.embody.entities().find((entity) => entity.index === sand).state, SAND);

  it("fills the cylinder, lets it collapse and come to rest, in the same place for every page", async () => {
    const filled = await points();
    assert.ok(filled.count > 300 && filled.count <= 600, `${filled.count} grains`);
    assert.ok(filled.upper[0] < 0.101 && filled.lower[1] > -0.001, JSON.stringify(filled));

    await command("simulation.step", { count: 240 });
    await page.waitForFunction((sand) => window.embody.points(sand).upper[0] > 0.12, SAND);
    assert.equal(await state(), ASLEEP);
    const heap = await points();
    assert.equal(heap.count, filled.count);
    assert.ok(heap.upper[1] < filled.upper[1]);

    // Nothing moves any more, but a page that connects later sees the heap, too.
    const later = await openStudio(session.browser, session.address);
    await later.waitForFunction((sand) => window.embody.points(sand), SAND);
    assert.deepEqual(await points(later), heap);
    await later.context().close();

    await command("simulation.reset", {});
    await page.waitForFunction((upper) => window.embody.points(2).upper[1] === upper, filled.upper[1]);
    assert.deepEqual(page.faults, []);
  });

  it("is selected as one entity by a click on a grain, and marked by its outline", async () => {
    await command("simulation.step", { count: 200 });
    await page.waitForFunction((sand) => window.embody.points(sand).upper[0] > 0.12, SAND);
    // Where the heap lies: a single grain that rolled away moves the middle of their box.
    const seen = await page.evaluate(() => window.embody.project(0, 0.02, 0));
    await page.mouse.click(seen.x, seen.y);
    assert.deepEqual(await page.evaluate(() => window.embody.selection()), [SAND]);
    await page.locator("[data-testid=attribute-simulated_diameter]").first().waitFor({ state: "attached" });
    const said = await page.locator("[data-testid=attribute-simulated_diameter] .source").first().textContent();
    assert.match(said, /stands for/);
    assert.deepEqual(page.faults, []);
  });

  it("becomes a solid thing and grains again while it runs, without a further click", async () => {
    await command("simulation.step", { count: 20 });
    await command("entity.set_attribute", { indices: [SAND], name: "kind", value: "rigid" });
    await page.waitForFunction((sand) => !window.embody.points(sand), SAND);
    await command("entity.set_attribute", { indices: [SAND], name: "kind", value: "granular" });
    await page.waitForFunction((sand) => window.embody.points(sand), SAND);
    // By hand: undo takes back what its own person did.
    await page.getByTestId("tab-In the scene").click();
    await page.locator(`[data-testid=hierarchy] [data-index="${SAND}"]`).click();
    await page.getByTestId("canvas").focus();
    await page.keyboard.press("Delete");
    await page.waitForFunction((sand) => !window.embody.points(sand), SAND);
    await page.keyboard.press("Control+z");
    await page.waitForFunction((sand) => window.embody.points(sand), SAND);
    assert.deepEqual(page.faults, []);
  });

  it("can be added as a primitive, by its category alone", async () => {
    await page.locator("[data-testid=primitive-sand]").dblclick();
    await page.waitForFunction(() => window.embody.points(3)?.count > 100);
    const kind = page.locator("[data-testid=attribute-kind] select").first();
    assert.equal(await kind.inputValue(), "granular");
    assert.match(await page.locator("[data-testid=attribute-friction_angle] .source").first().textContent(), /sand/i);
    assert.deepEqual(page.faults, []);
  });
});
