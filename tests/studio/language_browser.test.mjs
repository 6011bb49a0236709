// SPDX-License-Identifier: MIT
// The Studio in other languages, on the real server: with the pseudo language each translated text stands between ⟦ and ⟧, so what does not was forgotten.
import assert from "node:assert/strict";
import { after, before, describe, it } from "node:test";
import { openStudio, takePicture } from "./browser.mjs";
import { Headset, wearHeadset } from "./headset.mjs";
import { Session } from "./session.mjs";

const box = (index, name, x, more = {}) => ({ index, name, shape: { type: "box", half_extents: [0.2, 0.2, 0.2] }, pose: { position: [x, 1, 0] }, ...more });
/** Names are of Greek letters, which the pseudo language does not look at: they are data. */
const SCENE = {
  embody_scene: 1,
  title: "Α",
  entities: [
    { index: 1, name: "Β", category: "floor", locked: true, shape: { type: "box", half_extents: [5, 0.1, 5] }, pose: { position: [0, -0.1, 0] }, attributes: { kind: "static" } },
    box(2, "Γ", -1),
    box(3, "Δ", 0, { attributes: { mass: 100000 } }),
    box(4, "Ε", 1, { attributes: { kind: "soft" } }),
    { index: 5, name: "Ζ", shape: { type: "capsule", radius: 0.01, half_height: 0.75 }, pose: { position: [2, 1, 0] }, attributes: { kind: "rope" } },
    { index: 6, name: "Η", category: "honey", shape: { type: "box", half_extents: [0.1, 0.1, 0.1] }, pose: { position: [3, 1, 0] } },
    { index: 7, name: "Θ", category: "sand", shape: { type: "cylinder", radius: 0.1, half_height: 0.1 }, pose: { position: [3, 1, 1] } },
    { index: 8, name: "Ι", shape: { type: "box", half_extents: [0.6, 0.001, 0.6] }, pose: { position: [-3, 1, 0] }, attributes: { kind: "cloth" } },
  ],
  joints: [{ index: 1, type: "hinge", entity_a: 2, entity_b: 3, anchor: [-0.5, 1, 0], axis: [0, 1, 0], limit: { lower: -1, upper: 1 }, motor: { speed: 1, max_force: 5 } }],
  actions: [
    { id: 1, trigger: { type: "signal", button: "Κ" }, effect: { type: "apply_impulse", impulse: [0, 5, 0] }, receiver: { index: 2 } },
    { id: 2, trigger: { type: "contact_begin", least_approach_speed: 1 }, effect: { type: "apply_force", force: [0, 5, 0], duration: 2 }, receiver: { category: "sand" } },
    { id: 3, trigger: { type: "time", time: 2, repeat_every: 1 }, effect: { type: "pause" } },
  ],
  camera: { position: [2, 3, 6], target: [0, 0.5, 0] },
};

/** Runs in the page: the visible texts, and what screen readers say, that hold words outside of ⟦…⟧. */
function unmarked() {
  // Names of models, authors and people, keys of the keyboard, the product, WordNet, addresses and commands to type.
  const DATA = ".brand, .key, code, kbd, .tile-name, .model-card, .member-name, .toasts .remedy, [data-testid=attribute-synset] select, [lang=en], [data-testid=attribute-front] select, [data-testid=connection]";
  const UNITS = /\b(?:kg|mm|cm|lm|min|rad|Pa|deg|fps|MB|GPa|ms|EA|EI|GJ|nm|CSV|glTF|VR|AR|WebGL|https?|Ctrl|Shift|Alt|Space|Enter|Escape|Home|End|Delete|PageUp|PageDown|SPDX|xx|yy|zz|xy|xz|yz)\b/g;
  const found = new Set();
  const look = (text, where) => {
    let rest = text;
    for (let before = ""; before !== rest; ) [before, rest] = [rest, rest.replaceAll(/⟦[^⟦⟧]*⟧/g, "")];
    // A sentence around another element has its two marks in two texts.
    rest = rest.replace(/⟦[^⟧]*$|^[^⟦]*⟧/, "").replaceAll(UNITS, "").replaceAll(/\((?:[a-z]+_)*[a-z]+\)$/gm, "");
    if (/[A-Za-z]{2,}/.test(rest)) found.add(`${where}: ${text}`);
  };
  for (const element of document.body.querySelectorAll("*")) {
    if (!element.checkVisibility({ visibilityProperty: true }) || element.closest(DATA)) continue;
    const where = element.closest("[data-testid]")?.dataset.testid ?? element.tagName;
    // A tile's name and licence are the model's, the sources of a material are books.
    if (/^(model-tile|preset-.*)$/.test(where)) continue;
    for (const name of ["title", "aria-label", "placeholder", "aria-description", "aria-valuetext", "alt"]) if (element.getAttribute(name)) look(element.getAttribute(name), `${where} ${name}`);
    for (const node of element.childNodes) if (node.nodeType === Node.TEXT_NODE && node.data.trim()) look(node.data, where);
  }
  return [...found];
}

describe("the Studio in other languages", { timeout: 900000 }, () => {
  const session = new Session();
  let page;

  before(() => session.start(SCENE));
  after(() => session.end());

  const open = async (language, options = {}) => {
    await page?.context().close();
    const address = new URL(session.address);
    if (language) address.searchParams.set("lang", language);
    page = session.page = await openStudio(session.browser, address.href, options);
    await session.command("scene.load", { scene: SCENE });
    await page.waitForFunction((count) => window.embody.entities().length === count, SCENE.entities.length);
  };
  const choose = async (index) => {
    await page.locator("[role=tab]").nth(1).click();
    await page.locator(`[data-testid=hierarchy] [data-index="${index}"]`).click();
    await page.getByTestId("attribute-kind").waitFor();
  };
  const openAll = () => page.evaluate(() => document.querySelectorAll("details").forEach((each) => (each.open = true)));
  const expectMarked = async (what) => {
    const left = await page.evaluate(unmarked);
    assert.deepEqual(left, [], what);
  };
  const picture = (name) => process.env.EMBODY_TEST_PICTURES && takePicture(page, `${process.env.EMBODY_TEST_PICTURES}/${name}.png`);
  const run = async (words) => {
    await page.keyboard.press("Control+k");
    await page.getByTestId("palette-input").fill(words);
    await page.keyboard.press("Enter");
    await page.getByTestId("palette").waitFor({ state: "detached" });
  };
  const close = async () => {
    await page.evaluate(() => document.querySelectorAll("dialog").forEach((each) => each.close()));
    await page.waitForFunction(() => !document.querySelector("dialog"));
  };

  it("marks all texts of the page, with nothing and with anything selected", async () => {
    await open("pseudo");
    assert.equal(await page.evaluate(() => document.documentElement.lang), "en-XA");
    await openAll();
    await expectMarked("nothing selected");
    for (const { index, name } of SCENE.entities) {
      await choose(index);
      await openAll();
      await page.waitForTimeout(200);
      await expectMarked(`${name} selected`);
    }
    await page.keyboard.press("Control+a");
    await page.waitForTimeout(300);
    await expectMarked("several selected");
  });

  it("marks all texts of dialogs and menus", async () => {
    await open("pseudo");
    await choose(2);
    for (const words of ["Open scene", "Save as", "Save a version", "Versions of this", "View options", "Help and keys", "History of catalogue", "picture of any size"]) {
      await run(words);
      await page.waitForTimeout(300);
      await expectMarked(words);
      await close();
    }
    await page.keyboard.press("Control+k");
    await expectMarked("all commands");
    await close();
    await page.getByTestId("people-open").click();
    await expectMarked("people");
    await close();
    await page.getByTestId("add-action").evaluate((button) => button.click());
    for (const which of ["trigger", "effect"]) {
      const list = page.getByTestId(which);
      for (const value of await list.evaluate((select) => [...select.options].map(({ value }) => value))) {
        await page.getByTestId(which).selectOption(value);
        await page.waitForTimeout(50);
        await expectMarked(`an action with ${value}`);
      }
    }
    await close();
    await page.getByTestId("canvas").click({ button: "right", position: { x: 300, y: 200 } });
    await expectMarked("menu of the picture");
    await page.keyboard.press("Escape");
    await run("Copies in rows");
    await expectMarked("copies in rows");
    await run("First steps");
    for (let step = 0; step < 4; ++step) {
      await expectMarked(`step ${step} of the tour`);
      await page.getByTestId("tour-next").click();
    }
  });

  it("marks all texts while it runs, and of the line of time", async () => {
    await open("pseudo");
    await choose(2);
    await page.getByTestId("simulation.play").click();
    await page.waitForFunction(() => window.embody.simulation().time > 1);
    await expectMarked("in a run");
    await page.getByTestId("simulation.play").click();
    await page.getByTestId("time.plots").click();
    await page.waitForTimeout(500);
    await expectMarked("plots");
    await page.getByTestId("time.film").click();
    await expectMarked("film");
    await close();
    await page.getByTestId("simulation.keep").click();
    await page.waitForTimeout(500);
    await expectMarked("after poses were kept");
    assert.deepEqual(page.faults, []);
  });

  it("marks all texts of the headset's panels", async () => {
    await open("pseudo", { prepare: (made) => wearHeadset(made) });
    const headset = new Headset(page);
    // What is drawn into the panels is read where it is drawn.
    await page.evaluate(() => {
      window.painted = new Set();
      const { fillText } = CanvasRenderingContext2D.prototype;
      CanvasRenderingContext2D.prototype.fillText = function (text, ...more) {
        window.painted.add(text);
        return fillText.call(this, text, ...more);
      };
    });
    await headset.enter();
    for (const id of ["models", "settings"]) {
      await headset.press("left", "x-button");
      await headset.click(id);
      await page.waitForTimeout(500);
    }
    await headset.click("controls");
    await page.waitForTimeout(500);
    const painted = await page.evaluate(() => [...window.painted]);
    assert.ok(painted.length > 40, "panels were painted");
    // A line that was cut has only one of the marks. Letters are keys of the keyboard, and names of models.
    const names = new Set((await session.command("catalog.search", { words: "", limit: 60 })).models.map(({ name }) => name));
    const left = painted.filter((text) => /[A-Za-z]{2}/.test(text) && !/[⟦⟧]/.test(text) && ![...names].some((name) => name.startsWith(text.replace("…", "").trim())));
    assert.deepEqual(left.filter((text) => !/^[\d.+-]+ ?(%|N|cm|m)?$/.test(text)), []);
  });

  it("speaks Chinese where the address, the user or the system says so", async () => {
    await open("zh");
    assert.equal(await page.evaluate(() => document.documentElement.lang), "zh-CN");
    assert.equal(await page.locator("[role=tab]").first().textContent(), "模型");
    await open(null, { locale: "zh-CN" });
    assert.equal(await page.locator("[role=tab]").first().textContent(), "模型", "as the system");
    await run("视图选项");
    await Promise.all([page.waitForNavigation(), page.getByTestId("option-language").selectOption("en")]);
    await page.waitForFunction(() => window.embody?.connected());
    assert.equal(await page.locator("[role=tab]").first().textContent(), "Models", "the user's choice counts more");
    await open(null);
    assert.equal(await page.evaluate(() => document.documentElement.lang), "en");
    assert.deepEqual(page.faults, []);
  });

  it("leaves the dictionaries to those who need them", async () => {
    const loaded = [];
    const listen = (made) => made.on("request", (request) => loaded.push(new URL(request.url()).pathname));
    await open(null, { prepare: async (made) => listen(made) });
    assert.ok(loaded.length > 0 && !loaded.some((path) => /\/zh[-_]/.test(path)), "English pages load none");
    await open("zh", { prepare: async (made) => listen(made) });
    assert.ok(loaded.some((path) => /\/zh[-_]/.test(path)));
  });

  it("finds values by their Chinese names and by English ones", async () => {
    await open("zh");
    await choose(2);
    const search = page.getByTestId("value-search");
    const isShown = (name) => page.getByTestId(`attribute-${name}`).isVisible();
    for (const words of ["摩擦", "静摩擦系数", "打滑", "static friction", "slippery"]) {
      await search.fill(words);
      assert.ok(await isShown("friction_static"), words);
      assert.ok(!(await isShown("mass")), words);
    }
    await search.fill("重力");
    assert.ok(await isShown("gravity_factor"));
  });

  it("tells the server's refusals and the steps of undo in Chinese", async () => {
    await open("zh");
    await choose(2);
    const field = page.locator("[data-testid=attribute-restitution] input").first();
    await field.fill("3");
    await field.press("Enter");
    await page.locator(".field-error").first().waitFor();
    assert.match(await page.locator(".field-error").first().innerText(), /必须在 0 到 1 之间/);
    await field.fill("0.5");
    await field.press("Enter");
    await page.waitForFunction(() => document.querySelector("[data-testid='edit.undo']").title.includes("恢复系数"));
    assert.equal(await page.getByTestId("edit.undo").getAttribute("title"), "撤销：设定 Γ 的恢复系数（Ctrl+Z）");
  });

  it("fits Chinese into the page, dark and light, small and large", async () => {
    for (const [width, height] of [[1280, 720], [1920, 1080]]) {
      for (const colorScheme of ["dark", "light"]) {
        await open("zh", { width, height, colorScheme });
        await choose(3);
        await picture(`zh-${width}-${colorScheme}`);
        // What is too long for its place ends in an ellipsis or is cut off.
        const cut = await page.evaluate(() =>
          [...document.querySelectorAll("button, .attribute-label, summary, .cell, h2, h3, [role=tab]")].filter((each) => each.checkVisibility() && each.scrollWidth > each.clientWidth + 1 && !each.closest("[data-testid=model-grid], [data-testid=hierarchy]")).map((each) => each.textContent),
        );
        assert.deepEqual(cut, [], `${width} × ${height}`);
      }
    }
  });
});
