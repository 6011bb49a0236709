// SPDX-License-Identifier: MIT
// The first start: the Studio is there at once, and fills while one looks.
import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";
import { closeSync, mkdirSync, mkdtempSync, openSync, rmSync, writeFileSync, writeSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, afterEach, before, beforeEach, describe, it } from "node:test";
import { openBrowser, openStudio, takePicture } from "./browser.mjs";
import { findProgram, RealServer } from "./real_server.mjs";
import { commandFrom } from "./session.mjs";

/** A box as OBJ, 0.6 m high; another width is another model. */
function boxObj(width) {
  const corners = [];
  for (const x of [0, width]) for (const y of [0, 0.6]) for (const z of [0, 0.6]) corners.push(`v ${x} ${y} ${z}`);
  return [...corners, "f 1 2 4 3", "f 5 7 8 6", "f 1 5 6 2", "f 3 4 8 7", "f 1 3 7 5", "f 2 6 8 4"].join("\n");
}

const FLOOR = { name: "Floor", shape: { type: "plane", normal: [0, 1, 0], offset: 0 }, attributes: { kind: "static" } };

describe("the first start", { timeout: 900000 }, () => {
  const program = findProgram();
  let folder, browser, server, page, address, list;

  before(async () => {
    assert.ok(program, "the program embody is not built: build it, or set EMBODY_PROGRAM");
    browser = await openBrowser();
  });
  after(() => browser?.close());
  beforeEach(async () => {
    folder = mkdtempSync(join(tmpdir(), "embody-first-"));
    for (const [name, count, width] of [["early", 5, 0.3], ["late", 4, 0.8]]) {
      mkdirSync(join(folder, name));
      for (let i = 0; i < count; ++i) writeFileSync(join(folder, name, `${name} ${i}.obj`), boxObj(width + 0.05 * i));
    }
    const keys = keysOf("early", "late");
    const things = Object.keys(keys).sort().map((name, at) => ({ name, model: keys[name], pose: { position: [1.2 * at - 5, 0, 0] } }));
    assert.equal(things.length, 9);
    const pipe = join(folder, "list");
    assert.equal(spawnSync("mkfifo", [pipe]).status, 0);
    server = new RealServer(program, join(folder, "nothing"));
    const scene = { embody_scene: 1, title: "First room", entities: [FLOOR, ...things], camera: { position: [0, 3, 9], target: [0, 0.4, 0] } };
    address = await server.start(scene, ["--fill-list", pipe]);
    list = openSync(pipe, "w");
    page = await openStudio(browser, address, { prepare: rememberToasts });
  });
  afterEach(async () => {
    assert.deepEqual(page.faults, []);
    if (list !== null) closeSync(list);
    await page.context().close();
    await server.discard();
    rmSync(folder, { recursive: true, force: true });
  });

  // The keys that the models of these folders will have, by their names.
  function keysOf(...names) {
    const database = join(folder, "other.sqlite");
    const done = spawnSync(program, ["import", "--database", database, ...names.map((name) => join(folder, name))], { encoding: "utf8" });
    assert.equal(done.status, 0, done.stderr);
    const keys = {};
    for (const name of names) {
      const found = spawnSync(program, ["search", "--database", database, "--json", "--limit", "100", name], { encoding: "utf8" });
      for (const model of JSON.parse(found.stdout).models) keys[model.name] = model.key;
    }
    return keys;
  }
  // A message goes by itself, on a slow machine before the test has looked: what was said is kept.
  const rememberToasts = (made) =>
    made.addInitScript(() => {
      window.said = [];
      new MutationObserver((changes) => {
        for (const { addedNodes } of changes) for (const node of addedNodes) if (node instanceof HTMLElement && node.matches(".toast")) window.said.push(node.textContent);
      }).observe(document, { childList: true, subtree: true });
    });
  const said = (text) => page.waitForFunction((text) => window.said.some((each) => each.includes(text)), text);
  const drawn = () => page.evaluate(() => window.embody.entities().filter((entity) => entity.drawn).length);
  const untilDrawn = (count) => page.waitForFunction((wanted) => window.embody.entities().filter((entity) => entity.drawn).length === wanted, count, { timeout: 60000 });
  const command = (name, params) => commandFrom(page, name, params);
  const progress = () => page.getByTestId("library-progress");
  const tileNames = () => page.getByTestId("model-tile").evaluateAll((tiles) => tiles.map((tile) => tile.getAttribute("aria-label")));
  function finish() {
    closeSync(list);
    list = null;
  }

  it("shows the scene and how far the library is, and things appear as their models come", async () => {
    await said("9 things wait for their models");
    assert.equal(await drawn(), 1, "the floor");
    await page.getByText("looking for models").waitFor();
    assert.equal((await page.evaluate(() => window.embody.entities().length)), 10, "nothing of the scene is lost");
    await page.getByTestId("tab-In the scene").click();
    // The list of things is filled a moment after the scene came.
    await page.getByText("waits for its model").nth(8).waitFor();
    assert.equal(await page.getByText("waits for its model").count(), 9);
    await page.getByTestId("tab-Models").click();
    if (process.env.EMBODY_PICTURES) await takePicture(page, join(process.env.EMBODY_PICTURES, "first-start-waiting.png"));

    writeSync(list, join(folder, "early") + "\n");
    await untilDrawn(6);
    await page.waitForFunction(() => document.querySelectorAll("[data-testid=model-tile][aria-label^=early]").length === 5, null, { timeout: 60000 });
    assert.ok(await progress().isVisible());
    writeSync(list, join(folder, "late") + "\n");
    await untilDrawn(10);
    finish();
    await said("The library is filled: 9 new models");
    assert.ok(await progress().isHidden());
    // The tiles are asked for anew at the end.
    for (const name of ["early 0", "late 3"]) await page.locator(`[data-testid=model-tile][aria-label='${name}']`).waitFor();
    if (process.env.EMBODY_PICTURES) await takePicture(page, join(process.env.EMBODY_PICTURES, "first-start-filled.png"));
  });

  it("tells a page that comes later, and things appear in a running simulation", async () => {
    writeSync(list, join(folder, "early") + "\n");
    await untilDrawn(6);
    const other = await openStudio(browser, address);
    await other.getByTestId("library-progress").waitFor();
    await other.waitForFunction(() => window.embody.entities().filter((entity) => entity.drawn).length === 6);
    await other.context().close();

    await page.keyboard.press("Space");
    await page.waitForFunction(() => window.embody.simulation().state === "playing");
    // What waits is moved and deleted as anything else.
    const [first, second] = (await page.evaluate(() => window.embody.entities())).filter(({ name }) => name.startsWith("late"));
    await command("entity.transform", { poses: [{ index: first.index, position: [0, 2.5, 2] }] });
    await page.getByTestId("tab-In the scene").click();
    await page.locator(`[data-testid=hierarchy] [data-index="${second.index}"]`).click();
    await page.keyboard.press("Delete");
    await page.waitForFunction((index) => window.embody.entities().every((entity) => entity.index !== index), second.index);
    writeSync(list, join(folder, "late") + "\n");
    await untilDrawn(9);
    const arrived = (await page.evaluate(() => window.embody.entities())).find(({ index }) => index === first.index);
    assert.ok(Math.abs(arrived.position[2] - 2) < 1, `it comes where it was moved to, and falls from there: ${arrived.position}`);
    assert.equal((await page.evaluate(() => window.embody.simulation())).state, "playing");
    await page.getByTestId("edit.undo").click();
    await untilDrawn(10);
    await page.getByTestId("tab-Models").click();
    finish();
  });

  it("lets tiles stand still under the pointer, and keeps the place in the list", async () => {
    writeSync(list, join(folder, "late") + "\n");
    // All of them: none comes any more while the pointer goes there.
    await page.waitForFunction(() => document.querySelectorAll("[data-testid=model-tile][aria-label^=late]").length === 4, null, { timeout: 60000 });
    const names = await tileNames();
    await page.getByTestId("model-grid").hover();
    writeSync(list, join(folder, "early") + "\n");
    await untilDrawn(10);
    await page.waitForTimeout(2600);
    assert.deepEqual(await tileNames(), names);
    await page.getByTestId("canvas").hover();
    await page.locator("[data-testid=model-tile][aria-label='early 0']").waitFor();
    finish();
  });
});
