// SPDX-License-Identifier: MIT
// Large scenes and many commands at once: the real server, the real furniture catalogue, a real browser.
import assert from "node:assert/strict";
import { after, afterEach, before, beforeEach, describe, it } from "node:test";
import { Session, until } from "./session.mjs";

const FLOOR = { index: 1, name: "Floor", shape: { type: "plane", normal: [0, 1, 0], offset: 0 }, attributes: { kind: "static" }, locked: true };
const EMPTY = { embody_scene: 1, title: "Empty", entities: [FLOOR] };
const MODELS = 460;
const BOXES = 400;
const ALONG = 23;

describe("large scenes in the Studio", { timeout: 900000 }, () => {
  const session = new Session();
  let page;

  before(() => session.start(EMPTY));
  after(() => session.end());
  beforeEach(async () => {
    page = await session.reopen();
  });
  // The next page begins with nothing loaded.
  afterEach(async () => {
    assert.deepEqual(page.faults, []);
    await session.command("scene.load", { scene: EMPTY });
  });

  it("loads 460 different models with few requests at once, tells how far it is, and keeps the connection", async () => {
    const keys = [];
    while (keys.length < MODELS) {
      const { models } = await session.command("catalog.search", { limit: 100, offset: keys.length });
      assert.ok(models.length > 0, "the catalogue has too few models");
      keys.push(...models.map(({ key }) => key));
    }
    const entities = keys.slice(0, MODELS).map((model, at) => ({ index: 2 + at, model, pose: { position: [2 * (at % ALONG) - ALONG, 0, 2 * Math.floor(at / ALONG) - ALONG] } }));
    let under = 0;
    let most = 0;
    page.on("request", (request) => request.url().includes("geometry.glb") && (most = Math.max(most, ++under)));
    for (const end of ["requestfinished", "requestfailed"]) page.on(end, (request) => request.url().includes("geometry.glb") && --under);
    // Every figure that the status bar shows.
    await page.evaluate(() => {
      window.figures = [];
      const figure = document.querySelector("[data-testid=stat-loading]");
      new MutationObserver(() => figure.hidden || window.figures.push(figure.textContent)).observe(figure, { childList: true, characterData: true, subtree: true });
    });
    let closed = false;
    await page.exposeFunction("lost", () => (closed = true));
    await page.evaluate(() => new MutationObserver(() => document.body.classList.contains("disconnected") && window.lost()).observe(document.body, { attributes: true }));

    await session.command("scene.load", { scene: { embody_scene: 1, title: "All models", entities: [FLOOR, ...entities] } });
    await page.waitForFunction((count) => window.embody.entities().length === count && window.embody.loading() === 0, MODELS + 1, { timeout: 240000 });
    const drawn = await page.evaluate(() => window.embody.entities().filter((entity) => entity.drawn).length);
    assert.equal(drawn, MODELS + 1);
    assert.ok(!closed, "the connection was never lost");
    assert.ok(most > 1 && most <= 6, `${most} models were requested at once`);
    const figures = await page.evaluate(() => window.figures);
    const counts = figures.map((text) => Number(/^Loading models: (\d+) of 460$/.exec(text)?.[1] ?? NaN));
    assert.ok(counts.length > 50 && !counts.includes(NaN) && counts.at(-1) > 400, `figures ${figures.slice(0, 5)}`);
    assert.ok(!(await page.getByTestId("stat-loading").isVisible()));
  });

  it("loads what is large and near before what is small and far", async () => {
    const { models } = await session.command("catalog.search", { limit: 60 });
    const order = [];
    page.on("request", (request) => {
      const id = /models\/(\d+)\/geometry/.exec(request.url())?.[1];
      if (id) order.push(Number(id));
    });
    // The nearest stands last in the list.
    const entities = models.map(({ key }, at) => ({ index: 2 + at, model: key, pose: { position: [0, 0, -6 * (models.length - at)] } }));
    const scene = { embody_scene: 1, title: "A row of models", entities: [FLOOR, ...entities], camera: { position: [0, 1.5, 4], target: [0, 0.5, 0] } };
    await session.command("scene.load", { scene });
    await page.waitForFunction((count) => window.embody.entities().length === count && window.embody.loading() === 0, entities.length + 1, { timeout: 60000 });
    const ids = models.map(({ id }) => id);
    const rank = order.map((id) => ids.indexOf(id)).filter((at) => at >= 0);
    const mean = (part) => part.reduce((sum, at) => sum + at, 0) / part.length;
    const half = Math.floor(rank.length / 2);
    assert.ok(rank.length > 20 && mean(rank.slice(0, half)) > mean(rank.slice(half)), `order ${rank}`);
  });

  it("sends an edit of 400 things at once and loses none", async () => {
    const entities = Array.from({ length: BOXES }, (_, at) => ({ index: 2 + at, shape: { type: "box", half_extents: [0.1, 0.1, 0.1] }, pose: { position: [0.5 * (at % 20), 0.1, 0.5 * Math.floor(at / 20)] } }));
    await session.command("scene.load", { scene: { embody_scene: 1, title: "Boxes", entities: [FLOOR, ...entities] } });
    await page.waitForFunction((count) => window.embody.entities().length === count, BOXES + 1);
    await page.getByTestId("canvas").focus();
    await page.keyboard.press("Control+a");
    await page.getByText(`${BOXES} entities`, { exact: true }).waitFor();
    await page.getByText("Start and forces").click();
    await page.getByLabel("Velocity y", { exact: true }).fill("1.5");
    await page.getByLabel("Velocity y", { exact: true }).press("Enter");
    const changed = async () => (await session.command("hello")).scene.entities.filter(({ linear_velocity }) => linear_velocity?.[1] === 1.5).length;
    await until(changed, (count) => count === BOXES, `of ${BOXES} so many have the velocity`, 120000);
    assert.ok(await page.evaluate(() => window.embody.connected()));
    await page.getByTestId("canvas").focus();
    await page.keyboard.press("Control+z");
    await until(changed, (count) => count === 0, "one undo takes back all", 120000);
  });
});
