// SPDX-License-Identifier: MIT
// The first minute: tour, gallery, small screens and fingers, the system's colours and motion, and what axe finds.
import assert from "node:assert/strict";
import { readdirSync, readFileSync } from "node:fs";
import { createRequire } from "node:module";
import { dirname, join } from "node:path";
import { after, afterEach, before, describe, it } from "node:test";
import { fileURLToPath } from "node:url";
import { openStudio, pictured, takePicture } from "./browser.mjs";
import { Session } from "./session.mjs";

const root = join(dirname(fileURLToPath(import.meta.url)), "..", "..");
const AXE = readFileSync(createRequire(join(root, "studio", "package.json")).resolve("axe-core/axe.min.js"), "utf8");
const FLOOR = { index: 1, name: "Floor", shape: { type: "plane", normal: [0, 1, 0], offset: 0 }, attributes: { kind: "static" }, locked: true };
const BOX = { index: 2, name: "Box", shape: { type: "box", half_extents: [0.3, 0.3, 0.3] }, pose: { position: [0, 0.3, 0] } };
const ROOM = { embody_scene: 1, title: "First room", entities: [FLOOR, BOX], camera: { position: [2, 2, 3], target: [0, 0.3, 0] } };

describe("the first minute", { timeout: 600000 }, () => {
  const session = new Session();
  let page;

  before(() => session.start(ROOM));
  after(() => session.end());
  afterEach(async () => {
    assert.deepEqual(page.faults, []);
    await page.context().close();
  });

  async function open(options = {}) {
    page = session.page = await openStudio(session.browser, session.address, options);
    await session.command("scene.load", { scene: ROOM });
    await page.waitForFunction(() => window.embody.entities().filter(({ drawn }) => drawn).length === 2);
    return page;
  }
  const picture = (name) => process.env.EMBODY_TEST_PICTURES && takePicture(page, join(process.env.EMBODY_TEST_PICTURES, `${name}.png`));
  const seen = (index) => page.evaluate((index) => window.embody.seenAt(index), index);
  const widthOfScene = () => page.evaluate(() => document.querySelector("[data-testid=canvas]").clientWidth);
  const camera = () => page.evaluate(() => window.embody.camera());
  const distance = ({ position, target }) => Math.hypot(...position.map((each, axis) => each - target[axis]));
  /** Fingers that are put down together, move in steps, and are lifted. */
  async function touch(from, to, steps = 6) {
    const client = await page.context().newCDPSession(page);
    const at = (part) => from.map((finger, id) => ({ id, x: finger.x + part * (to[id].x - finger.x), y: finger.y + part * (to[id].y - finger.y) }));
    await client.send("Input.dispatchTouchEvent", { type: "touchStart", touchPoints: at(0) });
    for (let step = 1; step <= steps; ++step) await client.send("Input.dispatchTouchEvent", { type: "touchMove", touchPoints: at(step / steps) });
    await client.send("Input.dispatchTouchEvent", { type: "touchEnd", touchPoints: [] });
  }

  it("leads through four steps, each done by doing it, and does not come again", async () => {
    const address = `${session.address}?tour=yes`;
    page = session.page = await openStudio(session.browser, address);
    const title = () => page.locator("[data-testid=tour] h3").innerText();
    await page.getByTestId("tour").waitFor();
    await session.command("scene.load", { scene: ROOM });
    await page.waitForFunction(() => window.embody.entities().filter(({ drawn }) => drawn).length === 2);
    await picture("tour");
    assert.equal(await title(), "Bring something in");
    await session.command("entity.add", { entity: { shape: { type: "sphere", radius: 0.2 }, pose: { position: [1, 0.2, 0] } } });
    await page.waitForFunction(() => document.querySelector("[data-testid=tour] h3").textContent === "Let it go");
    await page.getByTestId("simulation.play").click();
    await page.waitForFunction(() => document.querySelector("[data-testid=tour] h3").textContent === "Take hold of it");
    const at = await seen(2);
    await page.mouse.move(at.x, at.y);
    await page.mouse.down();
    await page.mouse.move(at.x + 30, at.y - 30, { steps: 6 });
    await page.waitForFunction(() => document.querySelector("[data-testid=tour] h3").textContent === "See what it is");
    await page.mouse.up();
    await page.getByTestId("tab-In the scene").click();
    await page.locator('[data-testid=hierarchy] [data-index="2"]').click();
    await page.getByTestId("tour").waitFor({ state: "hidden" });
    await session.command("simulation.reset");
    await page.reload();
    await page.waitForFunction(() => window.embody?.connected() && window.embody.loading() === 0);
    assert.ok(await page.getByTestId("tour").isHidden());
  });

  it("shows every example with a picture and a line about it", async () => {
    await open();
    await page.getByTestId("scene.open").click();
    await page.getByTestId("gallery").waitFor();
    const examples = readdirSync(join(root, "data", "scenes")).map((file) => file.replace(/\.json$/, ""));
    const cards = page.locator(".gallery-card");
    assert.equal(await cards.count(), examples.length);
    for (const name of examples) {
      const card = page.getByTestId(`scene-${name}`);
      await card.scrollIntoViewIfNeeded();
      await page.waitForFunction((name) => document.querySelector(`[data-testid="scene-${name}"] img`).naturalWidth === 640, name);
      assert.ok((await card.locator(".note").innerText()).length > 10, name);
    }
    await page.getByTestId(`scene-${examples[0]}`).scrollIntoViewIfNeeded();
    await picture("gallery");
    await page.getByTestId("scene-newtons_cradle").click();
    await page.waitForFunction(() => document.title.includes("Newton's cradle"));
  });

  it("folds its panels, and remembers that", async () => {
    await open();
    const before = await widthOfScene();
    await page.getByTestId("fold-left").click();
    await page.waitForFunction((before) => document.querySelector("[data-testid=canvas]").clientWidth > before + 150, before);
    await page.getByTestId("canvas").focus();
    await page.keyboard.press("Alt+2");
    await page.waitForFunction(() => document.querySelector("[data-testid=canvas]").clientWidth > 1250);
    await picture("folded");
    await page.reload();
    await page.waitForFunction(() => window.embody?.connected());
    assert.ok((await widthOfScene()) > 1250);
    assert.equal(await page.getByTestId("fold-left").getAttribute("aria-expanded"), "false");
    // What is folded away is not met by the Tab key either.
    assert.ok(await page.evaluate(() => document.querySelector(".panel.left").inert));
    await page.getByTestId("fold-left").click();
    await page.getByTestId("search").waitFor();
  });

  it("follows the system's colours until the user chooses", async () => {
    await open({ colorScheme: "light" });
    const theme = () => page.evaluate(() => document.documentElement.dataset.theme);
    assert.equal(await theme(), "light");
    await page.emulateMedia({ colorScheme: "dark" });
    await page.waitForFunction(() => document.documentElement.dataset.theme === "dark");
    await page.getByTestId("view.options").click();
    await page.getByTestId("option-theme").selectOption("light");
    await page.keyboard.press("Escape");
    assert.equal(await theme(), "light");
    await page.reload();
    await page.waitForFunction(() => window.embody?.connected());
    assert.equal(await theme(), "light");
  });

  it("jumps instead of gliding where less motion is wanted", async () => {
    await open({ reducedMotion: "reduce" });
    await page.getByTestId("tab-In the scene").click();
    await page.locator('[data-testid=hierarchy] [data-index="2"]').click();
    await page.getByTestId("canvas").focus();
    const before = distance(await camera());
    await page.keyboard.press("f");
    await pictured(page);
    const first = await camera();
    await page.waitForTimeout(600);
    assert.deepEqual(await camera(), first, "it is there with the first picture");
    assert.ok(Math.abs(distance(first) - before) > 0.1);
  });

  it("is whole on a phone, for fingers", async () => {
    await open({ width: 390, height: 844, hasTouch: true, isMobile: true });
    assert.ok((await widthOfScene()) > 380, "the scene has the width of the screen");
    assert.equal(await page.evaluate(() => document.documentElement.scrollWidth), 390, "and nothing is wider");
    await picture("phone");
    // One finger beside the things turns, two zoom and move.
    const before = await camera();
    await touch([{ x: 60, y: 700 }], [{ x: 160, y: 700 }]);
    await page.waitForFunction((before) => JSON.stringify(window.embody.camera()) !== before, JSON.stringify(before));
    const turned = await camera();
    assert.ok(Math.abs(distance(turned) - distance(before)) < 0.01, "turning keeps the distance");
    await touch([{ x: 150, y: 420 }, { x: 240, y: 420 }], [{ x: 60, y: 420 }, { x: 330, y: 420 }]);
    await page.waitForFunction((far) => Math.hypot(...window.embody.camera().position.map((each, axis) => each - window.embody.camera().target[axis])) < far, 0.6 * distance(turned));
    assert.deepEqual(await page.evaluate(() => window.embody.selection()), [], "two fingers select nothing");
    // A tap selects, and the panel lies over the scene.
    const near = distance(await camera());
    await session.command("scene.load", { scene: ROOM });
    await page.waitForFunction((near) => Math.hypot(...window.embody.camera().position.map((each, axis) => each - window.embody.camera().target[axis])) > 1.2 * near, near);
    await page.waitForFunction(() => window.embody.entities().filter(({ drawn }) => drawn).length === 2);
    const at = await seen(2);
    await page.touchscreen.tap(at.x, at.y);
    await page.waitForFunction(() => window.embody.selection().includes(2));
    await page.getByTestId("fold-right").tap();
    await page.getByTestId("attribute-mass").scrollIntoViewIfNeeded();
    await picture("phone_properties");
    assert.ok((await widthOfScene()) > 380, "over, not beside");
    await page.touchscreen.tap(20, 400);
    await page.waitForFunction(() => document.querySelector("[data-testid=fold-right]").getAttribute("aria-expanded") === "false");
    // A finger on a thing carries it.
    const start = await page.evaluate(() => window.embody.entities()[1].position[0]);
    await touch([await seen(2)], [{ x: at.x + 60, y: at.y }], 12);
    await page.waitForFunction((start) => Math.abs(window.embody.entities()[1].position[0] - start) > 0.1, start);
    // A tap at the very moment that a finger has left the picture is taken for a part of that gesture.
    await page.waitForTimeout(500);
    await page.getByTestId("simulation.play").tap();
    await page.waitForFunction(() => window.embody.simulation().state === "playing");
    await session.command("simulation.reset");
  });

  it("opens the menu for a finger that rests", async () => {
    await open({ width: 820, height: 1180, hasTouch: true });
    const at = await seen(2);
    const client = await page.context().newCDPSession(page);
    await client.send("Input.dispatchTouchEvent", { type: "touchStart", touchPoints: [{ x: at.x, y: at.y }] });
    await page.getByTestId("context-menu").waitFor();
    await client.send("Input.dispatchTouchEvent", { type: "touchEnd", touchPoints: [] });
    assert.deepEqual(await page.evaluate(() => window.embody.selection()), [2]);
    await picture("tablet");
  });

  for (const [name, options] of [["dark", {}], ["light", { colorScheme: "light" }], ["a phone", { width: 390, height: 844, hasTouch: true, isMobile: true }]])
    it(`gives axe nothing serious to say, ${name}`, async () => {
      await open(options);
      // The page's policy lets no script in but its own: the tool comes by the browser's own door.
      const client = await page.context().newCDPSession(page);
      await client.send("Runtime.evaluate", { expression: AXE });
      const examine = async (state) => {
        const found = await page.evaluate(() => window.axe.run(document, { resultTypes: ["violations"] }).then(({ violations }) => violations.map(({ id, impact, help, nodes }) => ({ id, impact, help, nodes: nodes.slice(0, 4).map(({ target, any }) => `${target} ${any[0]?.message ?? ""}`) }))));
        assert.deepEqual(found.filter(({ impact }) => impact === "serious" || impact === "critical"), [], state);
      };
      await examine("at the start");
      const at = await seen(2);
      if (options.hasTouch) {
        await page.touchscreen.tap(at.x, at.y);
        await page.getByTestId("fold-right").tap();
      } else await page.mouse.click(at.x, at.y);
      await page.waitForFunction(() => window.embody.selection().includes(2));
      await page.getByTestId("attribute-mass").waitFor();
      await examine("with a thing selected");
      if (options.hasTouch) return;
      for (const dialog of ["scene.open", "view.options", "view.palette", "view.help", "people-open"]) {
        await page.getByTestId(dialog).click();
        await page.locator("dialog[open]").waitFor();
        await examine(dialog);
        await page.keyboard.press("Escape");
        await page.locator("dialog[open]").waitFor({ state: "detached" });
      }
      await page.getByTestId("tab-In the scene").click();
      await examine("the list of things");
    });
});
