// SPDX-License-Identifier: MIT
// How the panels use the protocol, against a stand-in for the server: fast, and with any number of models.
import assert from "node:assert/strict";
import { after, before, beforeEach, describe, it } from "node:test";
import { openBrowser, openStudio, pictured } from "./browser.mjs";
import { MockServer } from "./mock_server.mjs";
import { allDone, until } from "./session.mjs";

const CRATE = 2;

describe("the Studio's panels", { timeout: 900000 }, () => {
  let browser, mock, page, address;

  before(async () => {
    browser = await openBrowser();
  });
  after(async () => {
    await browser?.close();
  });
  beforeEach(async () => {
    await page?.context().close();
    await mock?.stop();
    mock = new MockServer({ models: 60000 });
    address = await mock.start();
    page = await openStudio(browser, address);
  });
  after(async () => {
    await page?.context().close();
    await mock?.stop();
  });

  const field = (name) => page.locator(`[data-testid=attribute-${name}] input`).first();
  const select = (index) => page.locator(`[data-testid=hierarchy] [data-index="${index}"]`);
  async function choose(...indices) {
    await page.getByTestId("tab-In the scene").click();
    for (const [at, index] of indices.entries()) await select(index).click(at > 0 ? { modifiers: ["Control"] } : {});
    // Until their values have come, those of the first one alone are shown.
    await allDone(page);
  }
  const sent = (command) => mock.log.filter((each) => each.command === command).map((each) => each.params);

  it("says that no model matches, and shows all again", async () => {
    await page.getByTestId("search").fill("zeppelin");
    await page.getByTestId("empty-result").waitFor();
    assert.match(await page.getByTestId("empty-result").innerText(), /No model matches “zeppelin”/);
    assert.equal(await page.getByTestId("model-tile").count(), 0);
    await page.getByText("Show all models").click();
    await page.getByText("60,000 models").waitFor();
  });

  it("keeps few tiles alive among 60,000 and reaches the last", async () => {
    await page.getByText("60,000 models").waitFor();
    const grid = page.getByTestId("model-grid");
    assert.ok((await page.getByTestId("model-tile").count()) < 80);
    await grid.evaluate((element) => (element.scrollTop = element.scrollHeight));
    await page.locator("[data-key='mock/59999']").waitFor();
    assert.ok((await page.getByTestId("model-tile").count()) < 80);
  });

  it("adds the marked model with the keyboard alone", async () => {
    await page.keyboard.press("/");
    await page.keyboard.type("chair");
    // On a slow machine a part of the word is searched for, too, and finds as many.
    await until(() => sent("catalog.search").at(-1).words, (words) => words === "chair", "the last search");
    await allDone(page);
    await page.getByText("7,500 models").waitFor();
    await page.keyboard.press("Enter");
    await page.keyboard.press("ArrowRight");
    await page.keyboard.press("Enter");
    await page.waitForFunction(() => window.embody.entities().some((entity) => entity.model === "mock/8" && entity.drawn));
  });

  it("shows why the server refuses a value, beside the field", async () => {
    await choose(CRATE);
    await field("mass").fill("-3");
    await field("mass").press("Enter");
    await page.getByText("the mass must be above 0 kg").waitFor();
    await field("mass").fill("three");
    await field("mass").press("Enter");
    await page.getByText("This is not a number").waitFor();
    assert.equal(sent("entity.set_attribute").length, 1);
    await field("mass").fill("3,5");
    await field("mass").press("Enter");
    await page.getByTestId("reset-mass").waitFor();
    assert.deepEqual(sent("entity.set_attribute").at(-1), { indices: [CRATE], name: "mass", value: 3.5 });
    assert.equal(await page.locator(".field-error").count(), 0);
  });

  it("edits several entities at once and says where they differ", async () => {
    mock.commands["entity.add"]({ entity: { name: "Ball", shape: { type: "sphere", radius: 0.2 }, attributes: { mass: 2 } } });
    await choose(CRATE, 3);
    await page.getByText("2 entities", { exact: true }).waitFor();
    await page.waitForFunction(() => document.querySelector("[data-testid=attribute-mass] input")?.placeholder === "differs");
    await field("mass").fill("9");
    await field("mass").press("Enter");
    // The ball's mass could be reset before, so only the answer shows that both balls have the new one.
    await page.waitForFunction(() => document.querySelector("[data-testid=attribute-mass] input")?.placeholder !== "differs");
    assert.deepEqual(sent("entity.set_attribute").at(-1), { indices: [CRATE, 3], name: "mass", value: 9 });
    await page.getByTestId("reset-mass").click();
    await page.waitForFunction(() => document.querySelector("[data-testid=attribute-mass] input")?.value === "6.4");
  });

  it("moves with the handles as one step that undo takes back", async () => {
    await choose(CRATE);
    await page.getByTestId("tool.move").click();
    // The pointer meets the handles once they have been drawn.
    await pictured(page);
    const before = await page.evaluate((index) => window.embody.seenAt(index), CRATE);
    // The middle handle moves the entity in the plane of the picture.
    await page.mouse.move(before.x, before.y);
    await page.mouse.down();
    for (let step = 1; step <= 8; ++step) await page.mouse.move(before.x + 10 * step, before.y - 2 * step);
    await page.mouse.up();
    // The mock has the last place once it has answered.
    await allDone(page);
    await page.waitForFunction(() => !document.querySelector("[data-testid='edit.undo']").disabled);
    const moved = mock.entity(CRATE).pose.position;
    assert.notDeepEqual(moved, [0, 1, 0]);
    await page.keyboard.press("Control+z");
    await page.waitForFunction((index) => JSON.stringify(window.embody.entities().find((entity) => entity.index === index).position) === "[0,1,0]", CRATE);
    assert.equal(mock.past.length, 0);
  });

  it("takes a whole drag back by an undo right after it, however late the server answers", async () => {
    await choose(CRATE);
    await page.getByTestId("tool.move").click();
    await pictured(page);
    const { x, y } = await page.evaluate((index) => window.embody.seenAt(index), CRATE);
    mock.late = 300;
    await page.mouse.move(x, y);
    await page.mouse.down();
    for (let step = 1; step <= 8; ++step) {
      await page.mouse.move(x + 10 * step, y - 2 * step);
      await pictured(page);
      // The first place can be taken back before the last one is told.
      if (step === 1) await page.waitForFunction(() => !document.querySelector("[data-testid='edit.undo']").disabled);
    }
    await page.mouse.up();
    await page.keyboard.press("Control+z");
    await allDone(page);
    assert.ok(sent("entity.transform").length > 1);
    assert.equal(sent("edit.undo").length, 1);
    assert.deepEqual(mock.entity(CRATE).pose.position, [0, 1, 0]);
  });

  it("edits a pose by numbers, in degrees", async () => {
    await choose(CRATE);
    const y = page.getByLabel("Rotation y");
    await y.fill("90");
    await y.press("Enter");
    await page.waitForFunction((index) => Math.abs(window.embody.entities().find((entity) => entity.index === index).rotation[1] - Math.SQRT1_2) < 1e-3, CRATE);
  });

  it("selects by clicking, adds with Shift, and nothing in the empty sky", async () => {
    const at = await page.evaluate((index) => window.embody.seenAt(index), CRATE);
    await page.mouse.click(at.x, at.y);
    assert.deepEqual(await page.evaluate(() => window.embody.selection()), [CRATE]);
    await page.keyboard.down("Shift");
    await page.mouse.click(at.x, at.y + 200);
    await page.keyboard.up("Shift");
    assert.deepEqual(await page.evaluate(() => window.embody.selection()), [CRATE, 1]);
    await page.keyboard.press("Escape");
    assert.deepEqual(await page.evaluate(() => window.embody.selection()), []);
  });

  it("says that the server is gone, and takes up again when it is back", async () => {
    await mock.stop();
    await page.getByTestId("connection-lost").waitFor();
    assert.equal(await page.getByTestId("connection").innerText(), "Not connected");
    // A click during this time is not lost without a message.
    await page.getByTestId("simulation.play").click();
    await page.getByText("Not connected to the server").waitFor();
    mock = new MockServer({ models: 8, port: mock.port });
    mock.put({ name: "Newcomer", shape: { type: "sphere", radius: 0.3 } });
    await mock.start();
    await page.getByTestId("connection-lost").waitFor({ state: "hidden", timeout: 20000 });
    await page.waitForFunction(() => window.embody.entities().some((entity) => entity.name === "Newcomer"));
    await page.getByText("8 models", { exact: true }).waitFor();
  });

  it("takes a click on an icon that is exchanged while the button is down", async () => {
    const play = await page.getByTestId("simulation.play").boundingBox();
    await page.mouse.move(play.x + play.width / 2, play.y + play.height / 2);
    await page.mouse.down();
    // News write the bar anew.
    mock.broadcast({ event: "history", undo: "move Crate", redo: null });
    await page.waitForFunction(() => !document.querySelector("[data-testid='edit.undo']").disabled);
    await page.mouse.up();
    await page.waitForFunction(() => window.embody.simulation().state === "playing");
  });

  it("takes a click on a thing of the list that is filled anew meanwhile", async () => {
    await page.getByTestId("tab-In the scene").click();
    const row = await select(CRATE).boundingBox();
    await page.mouse.move(row.x + 20, row.y + row.height / 2);
    await page.mouse.down();
    mock.commands["entity.add"]({ entity: { name: "Ball", shape: { type: "sphere", radius: 0.2 } } });
    await page.waitForFunction(() => window.embody.entities().length === 3);
    // The list would be filled by now.
    await page.evaluate(() => new Promise((done) => setTimeout(done, 200)));
    await page.mouse.up();
    await page.waitForFunction((index) => window.embody.selection()[0] === index, CRATE);
    await select(3).waitFor();
  });

  it("shows the scene's own buttons, and hands its keys on while it plays", async () => {
    mock.scene.actions.push({ id: 1, trigger: { type: "signal", button: "Kick" } }, { id: 2, trigger: { type: "signal", key: "g" } });
    await page.reload();
    await page.getByTestId("scene-button-Kick").click();
    await page.waitForFunction(() => window.embody.connected());
    await page.getByTestId("simulation.play").click();
    await page.waitForFunction(() => window.embody.simulation().state === "playing");
    await page.keyboard.press("g");
    await page.getByTestId("simulation.play").click();
    await page.waitForFunction(() => window.embody.simulation().state === "paused");
    assert.deepEqual(sent("action.trigger"), [{ button: "Kick" }, { key: "g" }]);
  });

  it("keeps states and poses of a scene at rest when the page is loaded again", async () => {
    await page.getByTestId("simulation.play").click();
    await page.waitForFunction((index) => window.embody.entities().find((entity) => entity.index === index).state === 2, CRATE);
    await page.getByTestId("simulation.play").click();
    await page.reload();
    await page.waitForFunction((index) => window.embody?.entities().find((entity) => entity.index === index)?.state === 2, CRATE);
    const crate = (await page.evaluate(() => window.embody.entities())).find(({ index }) => index === CRATE);
    assert.ok(Math.abs(crate.position[1] - 0.2) < 1e-3, `at ${crate.position[1]} m`);
  });

  it("selects what lies in a rectangle", async () => {
    mock.commands["entity.add"]({ entity: { shape: { type: "sphere", radius: 0.2 }, pose: { position: [0.8, 0.3, 0] } } });
    await page.waitForFunction(() => window.embody.entities().length === 3);
    const canvas = await page.getByTestId("canvas").boundingBox();
    await page.keyboard.down("Control");
    await page.mouse.move(canvas.x + 10, canvas.y + 10);
    await page.mouse.down();
    await page.mouse.move(canvas.x + canvas.width - 10, canvas.y + canvas.height - 10, { steps: 4 });
    await page.mouse.up();
    await page.keyboard.up("Control");
    assert.deepEqual(await page.evaluate(() => window.embody.selection()), [CRATE, 3]);
  });

  it("draws what collides over the selection, each convex part by itself", async () => {
    await choose(CRATE);
    assert.equal(await page.evaluate(() => window.embody.collisionParts()), 0);
    await page.getByTestId("canvas").hover();
    await page.keyboard.press("c");
    await page.waitForFunction(() => window.embody.collisionParts() === 3);
    assert.deepEqual(sent("entity.collision_shape"), [{ index: CRATE }]);
    await page.keyboard.press("c");
    await page.waitForFunction(() => window.embody.collisionParts() === 0);
  });

  it("shows the progress of a long command, and lets only its own page stop it", async () => {
    const work = page.getByTestId("stat-work");
    // A server tells it again and again; without news the page takes it as done.
    let telling;
    const tell = (client, done) => {
      clearInterval(telling);
      const news = () => mock.broadcast({ event: "progress", client, done, total: 60000 });
      news();
      telling = setInterval(news, 150);
    };
    try {
      tell(7, 1200);
      await work.getByText("Changing models: 1,200 of 60,000").waitFor();
      await page.getByTestId("stop-work").click();
      tell(8, 1300);
      await work.getByText("1,300 of 60,000").waitFor();
      assert.ok(!(await page.getByTestId("stop-work").isVisible()));
    } finally {
      clearInterval(telling);
    }
    await allDone(page);
    assert.equal(sent("catalog.stop").length, 1);
    mock.broadcast({ event: "catalog", batch: 3, command: "set many", label: "Set Mass of 9 models", models: 9, keys: null, attributes: ["mass"], session: "studio: Eva", client: 8 });
    await page.getByText("Changed Mass of 9 models, by Eva").waitFor();
    await work.waitFor({ state: "hidden" });
  });

  it("finds commands by words in the palette", async () => {
    await page.keyboard.press("Control+k");
    await page.getByTestId("palette-input").fill("light th");
    await page.keyboard.press("Enter");
    assert.equal(await page.evaluate(() => document.documentElement.dataset.theme), "light");
  });

  it("asks before unsaved work is lost", async () => {
    await choose(CRATE);
    await page.keyboard.press("Delete");
    await page.waitForFunction(() => document.title.startsWith("•"));
    await page.getByTestId("scene.new").click();
    await page.getByTestId("unsaved-dialog").waitFor();
    await page.keyboard.press("Escape");
    await page.getByTestId("unsaved-dialog").waitFor({ state: "detached" });
    assert.equal(sent("scene.new").length, 0);
  });

  it("gives every control a name for screen readers", async () => {
    await choose(CRATE);
    await field("mass").waitFor();
    const nameless = await page.evaluate(() =>
      [...document.querySelectorAll("button, input, select")]
        .filter((control) => control.checkVisibility() && !control.getAttribute("aria-label") && !control.textContent.trim() && !control.closest("label"))
        .map((control) => control.outerHTML),
    );
    assert.deepEqual(nameless, []);
    assert.deepEqual(page.faults, []);
  });
});
