// SPDX-License-Identifier: MIT
// Soft bodies in the Studio: the drawn form bends with the nodes, and the property panel changes their kind while they move.
import assert from "node:assert/strict";
import { after, before, describe, it } from "node:test";
import { atRest } from "./browser.mjs";
import { Session } from "./session.mjs";

const BEAR = "sweethome3d:Blend Swap CC-0#teddyBear";
const SCENE = {
  embody_scene: 1,
  title: "Soft things",
  camera: { position: [1.6, 1, 2.2], target: [0.4, 0.3, 0] },
  entities: [
    { index: 1, name: "Floor", shape: { type: "box", half_extents: [5, 0.25, 5] }, pose: { position: [0, -0.25, 0] }, attributes: { kind: "static" } },
    {
      index: 2,
      name: "Cushion",
      shape: { type: "box", half_extents: [0.2, 0.1, 0.2] },
      pose: { position: [0, 0.1, 0] },
      attributes: { kind: "soft", mass: 1, youngs_modulus: 10000, damping_rayleigh: 0.02 },
    },
    { index: 3, name: "Weight", shape: { type: "sphere", radius: 0.1 }, pose: { position: [0, 0.31, 0] }, attributes: { mass: 4 } },
    { index: 4, name: "Bear", model: BEAR, pose: { position: [0.9, 0.01, 0] } },
  ],
};

describe("soft things in the Studio", { timeout: 600000 }, () => {
  const session = new Session();
  let page;

  before(async () => {
    await session.start(SCENE);
    page = await session.reopen();
    await page.waitForFunction(() => window.embody.bent(2) !== null && window.embody.bent(4) !== null, null, { timeout: 30000 });
  });
  after(() => session.end());

  const send = (name, params) => session.command(name, params);
  const bent = (index) => page.evaluate((index) => window.embody.bent(index), index);

  it("draws soft things at rest exactly in their form", async () => {
    // Quantised nodes are a few micrometres off; vertices outside of the tetrahedra are carried, too.
    const { size, vertices } = await bent(2);
    [0.4, 0.2, 0.4].forEach((extent, axis) => assert.ok(Math.abs(size[axis] - extent) < 1e-3, `${size}`));
    assert.ok(vertices > 100, "twelve triangles were made finer, so that they can bend");
    const bear = await bent(4);
    assert.ok(bear.size[1] > 0.3 && bear.size[1] < 0.33, `${bear.size}`);
    assert.deepEqual(page.faults, []);
  });

  it("lets a weight sink into a cushion that is seen to give way", async () => {
    await send("simulation.step", { count: 90 });
    // The frame comes after the event that tells of the steps, and bends the form with the next picture.
    await page.waitForFunction(() => window.embody.entities().find((entity) => entity.index === 3).position[1] < 0.3);
    await atRest(page);
    const { size, normals } = await bent(2);
    assert.ok(size[1] < 0.21 && size[1] > 0.1, `${size}`);
    assert.ok(size[0] > 0.4, "and it bulges");
    assert.ok(Math.abs(normals - 1) < 1e-3, "normals have length one");
    const ball = (await page.evaluate(() => window.embody.entities())).find((entity) => entity.index === 3);
    assert.ok(ball.position[1] < 0.299, `the ball has sunk in: ${ball.position}`);
    assert.ok(ball.position[1] > 0.12, `but not through: ${ball.position}`);
  });

  it("is picked where it is seen, and its kind is changed in the panel while it is dented", async () => {
    const at = await page.evaluate(() => window.embody.seenAt(4));
    assert.equal(await page.evaluate(({ x, y }) => window.embody.pick(x, y), at), 4);
    await page.mouse.click(at.x, at.y);
    await page.waitForFunction(() => window.embody.selection().includes(4));
    const kind = page.locator("[data-testid=attribute-kind] select").first();
    assert.equal(await kind.inputValue(), "soft");
    await kind.selectOption("rigid");
    await page.waitForFunction(() => window.embody.bent(4) === null);
    await page.waitForFunction(() => window.embody.entities().find((entity) => entity.index === 4).drawn);
    await send("simulation.step", { count: 5 });
    await kind.selectOption("soft");
    await page.waitForFunction(() => window.embody.bent(4) !== null);
    await send("simulation.reset", {});
    await page.waitForFunction(() => Math.abs((window.embody.bent(2)?.size[1] ?? 0) - 0.2) < 1e-3);
    assert.deepEqual(page.faults, []);
  });

  it("shows a kept dent before play, says so in the panel and forgets it", async () => {
    await send("simulation.step", { count: 120 });
    await page.getByTestId("simulation.keep").click();
    await page.waitForFunction(() => window.embody.simulation().state === "stopped");
    // The ball has sunk in, and the sides bulge.
    const isDented = () => page.waitForFunction(() => (window.embody.bent(2)?.size[0] ?? 0) > 0.403);
    await isDented();
    await atRest(page);
    const at = await page.evaluate(() => window.embody.seenAt(2));
    await page.mouse.click(at.x, at.y);
    await page.waitForFunction(() => window.embody.selection().includes(2));
    const line = page.getByTestId("kept-form");
    await line.waitFor();
    assert.match(await line.textContent(), /Form kept from a run/);

    await page.getByTestId("forget-form").click();
    await page.waitForFunction(() => Math.abs((window.embody.bent(2)?.size[1] ?? 0) - 0.2) < 1e-3);
    await line.waitFor({ state: "hidden" });
    await page.getByTestId("edit.undo").click();
    await isDented();
    await line.waitFor();
    assert.deepEqual(page.faults, []);
  });
});
