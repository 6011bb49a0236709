// SPDX-License-Identifier: MIT
// Cloth and ropes in the Studio: added from the list of primitives, bent by their nodes, blown by the wind, broken.
import assert from "node:assert/strict";
import { after, before, describe, it } from "node:test";
import { atRest, difference, openStudio, pictureOfScene } from "./browser.mjs";
import { allDone, Session } from "./session.mjs";

const SCENE = {
  embody_scene: 1,
  title: "Thin things",
  camera: { position: [2.2, 1.6, 3], target: [0.3, 0.8, 0] },
  entities: [
    { index: 1, name: "Floor", shape: { type: "box", half_extents: [5, 0.25, 5] }, pose: { position: [0, -0.25, 0] }, attributes: { kind: "static" } },
    {
      index: 2,
      name: "Cloth",
      shape: { type: "box", half_extents: [0.4, 0.002, 0.4] },
      pose: { position: [-0.6, 1.2, 0] },
      attributes: { kind: "cloth", cloth_nodes: 200 },
      pins: [{ position: [-0.4, 0, -0.4] }, { position: [0.4, 0, -0.4] }],
    },
    {
      index: 3,
      name: "Rope",
      shape: { type: "capsule", radius: 0.02, half_height: 0.6 },
      pose: { position: [0.9, 1.4, 0], rotation: { axis: [0, 0, 1], degrees: 90 } },
      attributes: { kind: "rope", mass: 2, slack: 0.1, rope_segments: 24 },
      pins: [{ position: [0, 0.6, 0] }, { position: [0, -0.6, 0] }],
    },
  ],
};

describe("cloth and ropes in the Studio", { timeout: 600000 }, () => {
  const session = new Session();
  let page;

  before(async () => {
    await session.start(SCENE);
    page = await session.reopen();
    await page.waitForFunction(() => window.embody.bent(2) !== null && window.embody.bent(3) !== null, null, { timeout: 30000 });
  });
  after(() => session.end());

  const send = (name, params) => session.command(name, params);
  const bent = (index) => page.evaluate((index) => window.embody.bent(index), index);

  it("draws a sheet with its thickness and a slack rope as an arc", async () => {
    const cloth = await bent(2);
    [0.8, 0.004, 0.8].forEach((extent, axis) => assert.ok(Math.abs(cloth.size[axis] - extent) < 1e-3, `${cloth.size}`));
    assert.ok(Math.abs(cloth.normals - 1) < 1e-3);
    // The rope's axis is the frame's Y; the sag of a rope that is longer by a fraction s is d √(3s/8), plus its thickness.
    const rope = await bent(3);
    assert.ok(rope.size[1] > 1.2 && rope.size[1] < 1.26, `${rope.size}`);
    const sag = 1.2 * Math.sqrt((3 * 0.1) / 8);
    assert.ok(Math.abs(rope.size[0] - sag - 0.04) < 0.03, `${rope.size} ${sag}`);
    assert.ok(Math.abs(rope.size[2] - 0.04) < 2e-3, `${rope.size}`);
    assert.deepEqual(page.faults, []);
  });

  it("lets cloth hang down, and wind lift it", async () => {
    await send("simulation.step", { count: 120 });
    // The frame comes after the event that tells of the steps.
    const lowest = () => page.evaluate(() => window.embody.entities().find((entity) => entity.index === 2).position[1]);
    await page.waitForFunction(() => window.embody.entities().find((entity) => entity.index === 2).position[1] < 1);
    const still = await lowest();
    const air = page.locator("[data-testid=scene-fields]").getByLabel("Wind z");
    await air.fill("-6");
    await air.press("Enter");
    // The steps are asked for by another client: not before the server has the wind.
    await allDone(page);
    await send("simulation.step", { count: 180 });
    await page.waitForFunction((still) => window.embody.entities().find((entity) => entity.index === 2).position[1] > still + 0.05, still);
    await atRest(page);
    const { normals } = await bent(2);
    assert.ok(Math.abs(normals - 1) < 1e-3, "normals have length one");
    // An active entity keeps its own colour, but for a faint tint; the full tint is an option.
    const covered = () => page.evaluate(() => window.embody.tintOf(2)[3]);
    assert.ok((await covered()) > 0 && (await covered()) < 0.2, `${await covered()}`);
    await page.evaluate(() => document.querySelector("[data-testid=canvas]").focus());
    await page.getByTestId("view.options").click();
    await page.getByTestId("option-view.fullTint").check();
    await page.waitForFunction(() => window.embody.tintOf(2)[3] > 0.8);
    await page.getByTestId("option-view.fullTint").uncheck();
    await page.waitForFunction(() => window.embody.tintOf(2)[3] < 0.2);
    await page.keyboard.press("Escape");
    assert.deepEqual(page.faults, []);
  });

  it("says that a rope broke and draws it in two", async () => {
    // The rope's ends carry 15 N, so it breaks there and its middle falls.
    await send("entity.set_attribute", { indices: [3], name: "break_tension", value: 14 });
    // Watched all the time: a form that was just made has normals of length one, too, before it first bends.
    await page.evaluate(() => {
      window.lengths = [];
      const look = () => {
        window.lengths.push(window.embody.bent(3)?.normals ?? null);
        window.looking = setTimeout(look);
      };
      look();
    });
    // The message goes by itself.
    await Promise.all([page.waitForSelector("text=/Rope broke at a tension of/"), send("simulation.step", { count: 60 })]);
    await page.waitForFunction(() => window.embody.simulation().step === 360);
    await page.waitForFunction(() => window.embody.entities().find((entity) => entity.index === 3).position[1] < 1);
    await page.waitForFunction(() => window.embody.bent(3) !== null);
    const lengths = await page.evaluate(() => (clearTimeout(window.looking), window.lengths));
    lengths.push((await bent(3)).normals);
    for (const length of lengths) assert.ok(length === null || Math.abs(length - 1) < 1e-3, `${length}`);
    assert.deepEqual(page.faults, []);
    // A rope that is broken everywhere has nothing to draw.
    await send("entity.set_attribute", { indices: [3], name: "break_tension", value: 0 });
    await send("simulation.step", { count: 60 });
    await page.waitForFunction(() => window.embody.simulation().step === 420 && window.embody.bent(3) !== null);
    assert.deepEqual(page.faults, []);
    await send("simulation.reset", {});
    await page.waitForFunction(() => Math.abs((window.embody.bent(3)?.size[1] ?? 0) - 1.23) < 0.05 && window.embody.bent(3).normals > 0.99);
  });

  it("starts with fast drawing without a graphics card, and draws a still scene finely", async () => {
    // A page without a choice of quality.
    const other = await openStudio(session.browser, session.address, { quality: "" });
    const software = await other.evaluate(() => {
      const gl = document.createElement("canvas").getContext("webgl2");
      return /llvmpipe|swiftshader/i.test(gl.getParameter(gl.getExtension("WEBGL_debug_renderer_info").UNMASKED_RENDERER_WEBGL));
    });
    await other.getByTestId("view.options").click();
    assert.equal(await other.getByTestId("option-view.quality").isChecked(), software);
    await other.keyboard.press("Escape");
    const points = (times) => other.waitForFunction((times) => document.querySelector("[data-testid=canvas]").width === times * document.querySelector("[data-testid=canvas]").clientWidth, times);
    await points(software ? 2 : 1);
    const drawn = await other.evaluate(() => window.embody.frames());
    await send("simulation.play", {});
    await other.waitForFunction((drawn) => window.embody.frames() > drawn + 3, drawn);
    await points(1);
    await send("simulation.reset", {});
    await points(software ? 2 : 1);
    assert.deepEqual(other.faults, []);
    await other.context().close();
    await page.waitForFunction(() => window.embody.simulation().state === "stopped");
  });

  it("is drawn as before after it was selected and deselected", async () => {
    await send("simulation.step", { count: 1 });
    await page.waitForFunction(() => window.embody.simulation().step === 1);
    const seen = await page.evaluate((index) => window.embody.seenAt(index), 2);
    await page.mouse.click(seen.x, seen.y);
    await page.waitForFunction((index) => window.embody.selection()[0] === index, 2);
    await atRest(page);
    await page.keyboard.press("Escape");
    await page.waitForFunction(() => window.embody.selection().length === 0);
    await atRest(page);
    await send("simulation.step", { count: 60 });
    await page.waitForFunction(() => window.embody.simulation().step === 61);
    const drawn = await pictureOfScene(page);
    // Another page that connects now sees the same.
    const other = await openStudio(session.browser, session.address);
    await other.waitForFunction(() => window.embody.bent(2) !== null && window.embody.bent(3) !== null);
    const share = await difference(page, drawn, await pictureOfScene(other));
    await other.context().close();
    assert.ok(share < 0.002, `${share} of the pixels differ`);
    await send("simulation.reset", {});
    await page.waitForFunction(() => window.embody.simulation().state === "stopped");
    assert.deepEqual(page.faults, []);
  });

  it("says what moves after single steps, and of a broken scene file its name, field and what to do", async () => {
    await page.evaluate(() => document.querySelector("[data-testid=canvas]").focus());
    await page.keyboard.press(".");
    await page.waitForFunction(() => document.querySelector("[data-testid=stat-active]").textContent === "2 of 2 active");
    assert.equal(await page.getByTestId("stat-rate").isVisible(), false, "single steps have no rate");
    await send("simulation.reset", {});
    await page.waitForFunction(() => window.embody.simulation().state === "stopped");

    const before = await page.evaluate(() => window.embody.entities().length);
    const text = JSON.stringify({ embody_scene: 1, entities: [{ shape: { type: "sphere", radius: 4711 } }] });
    for (const [number, said] of [
      ["1e999", /^broken\.json, line 1, column \d+: entities\[0\]\.shape\.radius: 1e999 is larger than a number can be/],
      ["1,,2", /^broken\.json, line 1, column \d+: entities\[0\]\.shape\.radius: is not JSON/],
      ["-1", /^broken\.json: entities\[0\]\.shape/],
    ]) {
      // A scene that is dropped is opened, not imported as a model.
      const drop = await page.evaluateHandle((text) => {
        const data = new DataTransfer();
        data.items.add(new File([text], "broken.json", { type: "application/json" }));
        return data;
      }, text.replace("4711", number));
      await page.dispatchEvent("#scene", "drop", { dataTransfer: drop, clientX: 500, clientY: 400 });
      // The scene has unsaved changes, so the Studio asks first.
      await page.getByTestId("leave-scene").click();
      await page.getByText(said).waitFor({ timeout: 20000 });
    }
    assert.equal(await page.evaluate(() => window.embody.entities().length), before);
    assert.deepEqual(page.faults, []);
  });

  it("is pinned by hand: at its edge, at a place that is clicked on, to another thing; and undo takes each back", async () => {
    const at = await page.evaluate(() => window.embody.seenAt(2));
    await page.mouse.click(at.x, at.y);
    await page.waitForFunction(() => window.embody.selection()[0] === 2);
    const said = page.getByTestId("pin-count");
    const says = (text) => page.waitForFunction((text) => document.querySelector("[data-testid=pin-count]").textContent.startsWith(text), text);
    await says("2 places are held");
    await page.waitForFunction(() => window.embody.pinned() === 2);
    await page.getByTestId("pin-none").click();
    await says("Nothing holds it");
    await page.getByTestId("pin-edge").click();
    await says("17 places");
    await page.keyboard.press("Control+z");
    await says("Nothing holds it");
    await page.getByTestId("pin-pick").click();
    await page.mouse.click(at.x, at.y);
    await says("1 place is held");
    await page.getByTestId("pin-holder").selectOption({ label: "Floor" });
    await page.waitForFunction(() => document.querySelector("[data-testid=pin-holder]").value === "1");
    // It shows the choice at once, and the steps are asked for by another client.
    await allDone(page);
    // Held by its middle alone the cloth hangs down around it, also while the simulation plays.
    await send("simulation.step", { count: 60 });
    await page.waitForFunction(() => window.embody.bent(2).size[1] > 0.15);
    await page.getByTestId("pin-corners").click();
    await says("5 places");
    await page.waitForFunction(() => window.embody.pinned() === 5);
    await page.keyboard.press("Control+z");
    await says("1 place is held");
    assert.ok(await said.isVisible());
    await page.keyboard.press("Escape");
    await page.waitForFunction(() => window.embody.selection().length === 0 && window.embody.pinned() === 0);
    assert.equal(await page.getByTestId("pins").isVisible(), false);
    await send("simulation.reset", {});
    assert.deepEqual(page.faults, []);
  });

  it("offers cloth, round cloth, rope and cushion among the primitives", async () => {
    for (const name of ["cloth", "round-cloth", "rope", "cushion"]) {
      const before = (await page.evaluate(() => window.embody.entities())).length;
      await page.locator(`[data-testid=primitive-${name}]`).dblclick();
      await page.waitForFunction((before) => window.embody.entities().length === before + 1, before);
      const index = await page.evaluate(() => Math.max(...window.embody.entities().map((entity) => entity.index)));
      await page.waitForFunction((index) => window.embody.bent(index) !== null, index);
    }
    assert.deepEqual(page.faults, []);
  });
});
