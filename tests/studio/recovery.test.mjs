// SPDX-License-Identifier: MIT
// Nothing is lost: recovered work, saving with title and camera, versions, and how scenes are opened.
import assert from "node:assert/strict";
import { after, afterEach, before, beforeEach, describe, it } from "node:test";
import { openStudio } from "./browser.mjs";
import { allDone, Session } from "./session.mjs";

const FLOOR = { index: 1, name: "Floor", shape: { type: "plane", normal: [0, 1, 0], offset: 0 }, attributes: { kind: "static" } };
const ROOM = { embody_scene: 1, title: "Room to lose", entities: [FLOOR, { index: 2, name: "Box", shape: { type: "box", half_extents: [0.2, 0.2, 0.2] }, pose: { position: [0, 0.2, 0] } }], camera: { position: [3, 2.4, 4], target: [0, 0.4, 0] } };

describe("saving and recovering", { timeout: 900000 }, () => {
  const session = new Session();
  let page;

  before(() => session.start(ROOM));
  after(() => session.end());
  beforeEach(async () => {
    page = await session.reopen();
    await load(ROOM);
  });
  afterEach(() => assert.deepEqual(page.faults.filter((fault) => !/WebSocket|ERR_CONNECTION/.test(fault)), []));

  async function load(scene) {
    await session.command("scene.load", { scene });
    await page.waitForFunction(([title, count]) => document.title.includes(title) && window.embody.entities().length === count, [scene.title, scene.entities.length]);
    await page.waitForFunction(() => window.embody.loading() === 0);
  }
  async function edit() {
    await page.getByTestId("tab-In the scene").click();
    await page.locator('[data-testid=hierarchy] [data-index="2"]').click();
    await page.getByLabel("Position y", { exact: true }).fill("1.5");
    await page.getByLabel("Position y", { exact: true }).press("Enter");
    await page.waitForFunction(() => document.title.startsWith("•"));
    await page.getByTestId("canvas").focus();
  }
  const camera = () => page.evaluate(() => window.embody.camera());
  async function turn() {
    const canvas = await page.getByTestId("canvas").boundingBox();
    await page.mouse.move(canvas.x + 30, canvas.y + 30);
    await page.mouse.down();
    await page.mouse.move(canvas.x + 200, canvas.y + 70, { steps: 5 });
    await page.mouse.up();
    return camera();
  }
  const apart = (a, b) => Math.hypot(...a.position.map((at, axis) => at - b.position[axis])) + Math.hypot(...a.target.map((at, axis) => at - b.target[axis]));
  // Kills the program as the power would; then starts it anew.
  async function crash(scene = ROOM) {
    const { process } = session.server;
    const ended = new Promise((resolve) => process.once("exit", resolve));
    process.kill("SIGKILL");
    await ended;
    session.address = await session.server.start(scene);
  }

  it("offers what a killed program had, and opens it", async () => {
    await edit();
    await crash();
    await page.context().close();
    page = session.page = await openStudio(session.browser, session.address, { recoveries: true });
    const dialog = page.getByTestId("recovery-dialog");
    await dialog.waitFor();
    assert.match(await dialog.innerText(), /Room to lose[^]*1 edit/);
    await dialog.getByTestId("recovery-open").first().click();
    await page.waitForFunction(() => Math.abs(window.embody.entities().find(({ index }) => index === 2)?.position[1] - 1.5) < 1e-3);
    assert.match(await page.title(), /^•/, "it is still not saved");
  });

  it("keeps for later without asking again, and discards from the list of scenes", async () => {
    await edit();
    await crash();
    await page.context().close();
    page = session.page = await openStudio(session.browser, session.address, { recoveries: true });
    await page.getByTestId("recovery-dialog").waitFor();
    await page.getByTestId("recovery-later").click();
    await page.reload();
    await page.waitForFunction(() => window.embody?.connected());
    assert.equal(await page.getByTestId("recovery-dialog").count(), 0);
    await page.getByTestId("scene.open").click();
    const discard = page.locator("[data-testid^='discard-autosave/']");
    await discard.first().waitFor();
    const before = await discard.count();
    await discard.first().click();
    await page.waitForFunction((count) => document.querySelectorAll("[data-testid^='discard-autosave/']").length === count - 1, before);
    await page.keyboard.press("Escape");
  });

  it("discards from the dialog at the start", async () => {
    await edit();
    await crash();
    await page.context().close();
    page = session.page = await openStudio(session.browser, session.address, { recoveries: true });
    const rows = page.locator("[data-testid^='recovery-autosave/']");
    await rows.first().waitFor();
    for (let left = await rows.count(); left > 0; --left) {
      await rows.first().getByTestId("recovery-discard").click();
      await page.waitForFunction((count) => document.querySelectorAll("[data-testid^='recovery-autosave/']").length === count, left - 1);
    }
    await page.getByTestId("recovery-dialog").waitFor({ state: "detached" });
    assert.ok(!(await session.command("scene.list")).scenes.some(({ kind }) => kind === "recovery"));
  });

  it("says before another scene is opened where unsaved work is kept, and keeps it there", async () => {
    await edit();
    await page.getByTestId("scene.new").click();
    const dialog = page.getByTestId("unsaved-dialog");
    await dialog.waitFor();
    assert.match(await dialog.innerText(), /Room to lose.*recovered scenes/);
    await page.getByTestId("leave-scene").click();
    await page.waitForFunction(() => !window.embody.entities().some(({ name }) => name === "Box"));
    // The page asks what was kept, to know of it.
    await allDone(page);
    await page.reload();
    await page.waitForFunction(() => window.embody?.connected());
    assert.equal(await page.getByTestId("recovery-dialog").count(), 0, "whoever left it knows of it");
    await page.getByTestId("scene.open").click();
    const kept = page.locator("[data-testid^='scene-autosave/']", { hasText: "Room to lose" });
    await kept.first().click();
    await page.waitForFunction(() => Math.abs(window.embody.entities().find(({ index }) => index === 2)?.position[1] - 1.5) < 1e-3);
  });

  it("takes the name as the title, and opens again where the camera was", async () => {
    await edit();
    const seen = await turn();
    await page.keyboard.press("Control+Shift+s");
    await page.getByTestId("save-name").fill("Flat");
    await page.keyboard.press("Enter");
    await page.waitForFunction(() => document.title === "Flat – Embody Studio");
    assert.equal(await page.getByTestId("scene-title").innerText(), "Flat");
    await page.getByTestId("scene.new").click();
    await page.waitForFunction(() => !document.title.startsWith("Flat"));
    await page.getByTestId("scene.open").click();
    await page.getByTestId("scene-Flat").click();
    await page.waitForFunction(() => document.title.startsWith("Flat"));
    assert.ok(apart(await camera(), seen) < 0.01, "the camera is where it was");
    assert.equal(new URL(page.url()).hash, "");
    assert.deepEqual([...new URL(page.url()).searchParams.keys()], ["quality", "tour"], "the address keeps nothing");
  });

  it("saves versions under names and opens one", async () => {
    await page.keyboard.press("Control+s");
    await page.getByTestId("save-name").fill("Versioned");
    await page.keyboard.press("Enter");
    await page.waitForFunction(() => document.title.startsWith("Versioned"));
    // The title comes with the event, before the answer that closes the dialog; until then keys are the dialog's.
    await page.getByTestId("save-dialog").waitFor({ state: "detached" });
    const run = async (words) => {
      await page.getByTestId("canvas").focus();
      await page.keyboard.press("Control+k");
      await page.getByTestId("palette-input").fill(words);
      await page.keyboard.press("Enter");
    };
    await run("save a version");
    await page.getByTestId("version-name").fill("before the move");
    // The message goes by itself.
    await Promise.all([page.getByText("its version “before the move”").waitFor(), page.keyboard.press("Enter")]);
    await page.getByTestId("version-dialog").waitFor({ state: "detached" });
    await edit();
    await run("versions of this");
    await page.getByTestId("version-before the move").click();
    await page.getByTestId("leave-scene").click();
    await page.waitForFunction(() => Math.abs(window.embody.entities().find(({ index }) => index === 2)?.position[1] - 0.2) < 1e-3);
  });

  it("opens a scene without a camera so that its furniture fills the picture, not its floor", async () => {
    const { models } = await session.command("catalog.search", { words: "chair", limit: 5 });
    const slab = { index: 1, name: "Slab", shape: { type: "box", half_extents: [10, 0.1, 10] }, pose: { position: [0, -0.1, 0] }, attributes: { kind: "static" } };
    const furniture = models.map(({ key }, at) => ({ index: 2 + at, model: key, pose: { position: [at - 2, 0, (at % 2) - 0.5] } }));
    await load({ embody_scene: 1, title: "Furnished slab", entities: [slab, ...furniture] });
    const { width, height } = await page.evaluate(() => window.embody.filled());
    assert.ok(Math.max(width, height) > 1 / 3 && width <= 1 && height <= 1, `${width} of the width, ${height} of the height`);
  });

  it("stays where the user looked when the connection was lost", async () => {
    const seen = await turn();
    await session.server.stop();
    await page.getByTestId("connection-lost").waitFor();
    await session.server.start(ROOM);
    await page.getByTestId("connection-lost").waitFor({ state: "hidden", timeout: 30000 });
    // The page was connected and had two things before: the answer to its greeting counts.
    await allDone(page);
    assert.equal(await page.evaluate(() => window.embody.entities().length), 2);
    assert.ok(apart(await camera(), seen) < 0.01);
  });
});
