// SPDX-License-Identifier: MIT
// The properties panel: what matters first, finding values, materials by a click, copies, what makes no sense, and the world of a scene; real models.
import assert from "node:assert/strict";
import { after, afterEach, before, beforeEach, describe, it } from "node:test";
import { takePicture } from "./browser.mjs";
import { allDone, Session, until } from "./session.mjs";

const box = (index, name, x) => ({ index, name, shape: { type: "box", half_extents: [0.2, 0.2, 0.2] }, pose: { position: [x, 0.2, 0] } });
const ROOM = {
  embody_scene: 1,
  title: "Values",
  entities: [
    { index: 1, name: "Floor", category: "floor", locked: true, shape: { type: "box", half_extents: [5, 0.1, 5] }, pose: { position: [0, -0.1, 0] }, attributes: { kind: "static" } },
    box(2, "Box", -1),
    box(3, "Crate", 0),
    { index: 4, name: "Ball", shape: { type: "sphere", radius: 0.2 }, pose: { position: [1, 0.2, 0] }, attributes: { mass: 3 } },
  ],
  camera: { position: [2, 2, 4], target: [0, 0.2, 0] },
};

describe("values in the Studio's panel", { timeout: 900000 }, () => {
  const session = new Session();
  let page;

  before(() => session.start(ROOM));
  after(() => session.end());
  beforeEach(async () => {
    page = await session.reopen({ width: 1280, height: 720 });
    await session.command("scene.load", { scene: ROOM });
    await page.waitForFunction((count) => window.embody.entities().filter((entity) => entity.drawn).length === count, ROOM.entities.length);
    await page.getByTestId("tab-In the scene").click();
  });
  afterEach(() => assert.deepEqual(page.faults, []));

  const picture = (name) => process.env.EMBODY_TEST_PICTURES && takePicture(page, `${process.env.EMBODY_TEST_PICTURES}/${name}.png`);
  const listed = (index) => page.locator(`[data-testid=hierarchy] [data-index="${index}"]`);
  const row = (name) => page.getByTestId(`attribute-${name}`);
  const field = (name) => row(name).locator("input, select").first();
  async function choose(...indices) {
    for (const [at, index] of indices.entries()) await listed(index).click(at > 0 ? { modifiers: ["Control"] } : {});
    await field("mass").waitFor();
    // Until their values have come, those of the last choice are shown.
    await allDone(page);
  }
  async function type(name, text) {
    await field(name).fill(text);
    await field(name).press("Enter");
  }
  const own = async (index) => (await session.command("hello")).scene.entities.find((each) => each.index === index)?.attributes ?? {};
  const shown = (name, value) => page.waitForFunction(([name, value]) => document.querySelector(`[data-testid=attribute-${name}] :is(input, select)`)?.value === value, [name, value]);

  it("shows what matters first, and folds the rest until it is opened", async () => {
    await choose(2);
    const essentials = await page.locator("[data-testid=essentials] .attribute").evaluateAll((rows) => rows.map((row) => row.dataset.name));
    assert.deepEqual(essentials, ["category", "kind", "surface_material", "mass", "friction_static", "friction_dynamic", "restitution"]);
    const first = await page.getByTestId("essentials").boundingBox();
    const place = await page.getByTestId("entity-fields").boundingBox();
    assert.ok(first.y < place.y, "what matters stands above the place");
    assert.equal(await row("density").isVisible(), false, "the rest is folded");
    // One click away: the source of a value.
    assert.equal(await row("mass").locator(".source").isVisible(), false);
    await page.getByTestId("why-mass").click();
    assert.ok((await row("mass").locator(".source").innerText()).length > 10);
    await picture("values");
    // What is opened stays open, for the next thing and after a reload.
    await page.locator("[data-testid=attributes] summary", { hasText: "Mass" }).click();
    await row("density").waitFor();
    await choose(3);
    await row("density").waitFor();
    await page.reload();
    await page.waitForFunction(() => window.embody?.connected() && window.embody.loading() === 0);
    await page.getByTestId("tab-In the scene").click();
    await choose(2);
    await row("density").waitFor();
  });

  it("finds values by what people call them, and only what was changed", async () => {
    await choose(4);
    const search = page.getByTestId("value-search");
    const found = () => page.locator("[data-testid=properties] .attribute:visible").evaluateAll((rows) => rows.map((row) => row.dataset.name ?? ""));
    await search.fill("weight");
    await page.waitForFunction(() => document.querySelector("[data-testid=attribute-friction_static]").classList.contains("filtered"));
    assert.ok((await found()).includes("mass"));
    await search.fill("slippery");
    await until(found, (names) => names.includes("friction_static") && names.includes("friction_dynamic") && !names.includes("mass"), "slippery things have little friction");
    await search.fill("densi");
    await row("density").waitFor();
    await search.fill("zeppelin");
    await page.getByTestId("no-value").waitFor();
    await search.press("Escape");
    await row("restitution").waitFor();
    assert.equal(await row("density").isVisible(), false, "what the search opened is folded again");
    await page.getByTestId("only-changed").click();
    await until(found, (names) => names.length === 1 && names[0] === "mass", "the ball's mass alone was set");
    await type("mass", "4");
    await until(() => own(4), ({ mass }) => mass === 4, "the mass is edited there");
    await page.getByTestId("only-changed").click();
    await row("kind").waitFor();
  });

  it("makes things of another material by one click, in one step", async () => {
    await choose(2, 4);
    await page.getByTestId("preset-steel").click();
    await until(() => own(4), (values) => values.surface_material === "steel" && values.mass === undefined, "the ball is of steel");
    await choose(2);
    await shown("mass", "502.4");
    await field("surface_material").waitFor();
    await picture("steel");
    await page.getByTestId("canvas").focus();
    await page.keyboard.press("Control+z");
    await until(() => own(4), ({ mass }) => mass === 3, "one undo takes both back");
    assert.deepEqual(await own(2), {});
    await page.getByTestId("more-presets").selectOption("cork");
    await shown("mass", "12.8");
  });

  it("gives the values of one thing to others", async () => {
    await choose(4);
    await page.getByTestId("copy-values").click();
    await choose(2, 3);
    await page.getByTestId("paste-values").click();
    await page.getByTestId("paste-go").waitFor();
    assert.equal(await page.getByTestId("paste-mass").isChecked(), true, "what was set by hand is ticked");
    assert.equal(await page.getByTestId("paste-restitution").isChecked(), false);
    await page.getByTestId("paste-restitution").check();
    await picture("paste");
    await page.getByTestId("paste-go").click();
    await until(() => own(3), ({ mass, restitution }) => mass === 3 && restitution > 0, "the crate has both");
    assert.deepEqual(await own(2), await own(3));
  });

  it("marks a sofa of a billion kilograms, beside the field and in the list, and mends it", async () => {
    const { models } = await session.command("catalog.search", { words: "sofa", limit: 20 });
    const sofa = models.find(({ category }) => category === "sofa") ?? models[0];
    const { index } = await session.command("entity.add", { entity: { model: sofa.key, name: "Sofa", pose: { position: [0, 0, -1.5] } } });
    await page.waitForFunction((index) => window.embody.entities().some((entity) => entity.index === index && entity.drawn), index, { timeout: 60000 });
    await choose(index);
    const usual = await field("mass").inputValue();
    await type("mass", "1e9");
    const warning = row("mass").locator(".value-warning");
    await warning.waitFor();
    assert.match(await warning.innerText(), /osmium/);
    const mark = listed(index).locator(".row-warning");
    await mark.waitFor();
    assert.match(await mark.getAttribute("title"), /Mass: 1e9 kg/);
    assert.equal(await listed(2).locator(".row-warning").isVisible(), false);
    await picture("contradiction");
    await page.getByTestId("mend-mass").click();
    await shown("mass", usual);
    await warning.waitFor({ state: "hidden" });
    await mark.waitFor({ state: "hidden" });
  });

  it("shows centre, contacts, forces and velocity of what is selected alone", async () => {
    await choose(2);
    const CENTER = 13, VELOCITY = 20, FORCE = 21;
    const drawn = (meaning, least) => page.waitForFunction(([meaning, least]) => (window.embody.debugCounts()[meaning]?.points ?? 0) + (window.embody.debugCounts()[meaning]?.lines ?? 0) >= least, [meaning, least]);
    await page.getByTestId("overlay-masses").click();
    await drawn(CENTER, 1);
    assert.equal(await page.evaluate(() => window.embody.debugCounts()[13].points), 1, "one centre: the others are not selected");
    await page.getByTestId("overlay-forces").click();
    await page.getByTestId("overlay-velocities").click();
    await session.command("simulation.step", { count: 30 });
    await drawn(FORCE, 6);
    await picture("overlays");
    await session.command("entity.update", { index: 2, entity: { linear_velocity: [2, 0, 0] } });
    await session.command("simulation.step", { count: 2 });
    await drawn(VELOCITY, 3);
    await page.keyboard.press("Escape");
    await page.waitForFunction(() => Object.keys(window.embody.debugCounts()).length === 0);
  });

  it("speaks of the world where nothing is selected", async () => {
    const labels = await page.locator("[data-testid=scene-fields] .attribute:visible .attribute-label").allInnerTexts();
    assert.deepEqual(labels.slice(0, 5), ["Title", "Where it is", "Gravity", "Ground", "Wind"]);
    assert.equal(await page.getByLabel("Time step, s").isVisible(), false, "the solver is folded away");
    await picture("world");
    await page.getByTestId("place-Moon").click();
    await until(async () => (await session.command("hello")).scene.settings, ({ gravity, air_density }) => gravity[1] === -1.62 && air_density === 0, "on the moon");
    await page.waitForFunction(() => document.querySelector("[data-testid=place-Moon]").getAttribute("aria-pressed") === "true");
    await page.getByTestId("only-changed").click();
    await page.waitForFunction(() => document.querySelectorAll("[data-testid=scene-fields] .attribute:not(.filtered)").length === 2);
    await page.getByTestId("only-changed").click();
    await page.locator("summary", { hasText: "Simulation accuracy" }).click();
    await page.getByLabel("Parts of a step").fill("8");
    await page.getByLabel("Parts of a step").press("Enter");
    await until(async () => (await session.command("hello")).scene.settings, ({ substeps }) => substeps === 8, "eight parts");
    await page.getByTestId("ground").click();
    assert.deepEqual(await page.evaluate(() => window.embody.selection()), [1]);
  });

  it("changes values that differ, each by its own", async () => {
    await session.command("entity.set_attribute", { indices: [2], name: "mass", value: 5 });
    await choose(2, 4);
    await page.waitForFunction(() => document.querySelector("[data-testid=attribute-mass] input").placeholder === "differs");
    await type("mass", "*2");
    await until(() => own(2), ({ mass }) => mass === 10, "twice the box's");
    await until(() => own(4), ({ mass }) => mass === 6, "twice the ball's");
    await page.getByLabel("Position x", { exact: true }).fill("+=0.5");
    await page.getByLabel("Position x", { exact: true }).press("Enter");
    await until(async () => (await session.command("hello")).scene.entities.map(({ pose }) => pose.position[0]), (xs) => xs[1] === -0.5 && xs[3] === 1.5, "both half a metre on");
  });

  it("adds copies in rows after showing where they come to be", async () => {
    await choose(2);
    await page.keyboard.press("Control+Shift+D");
    await page.getByTestId("array-card").waitFor();
    await page.getByLabel("Copies along x").fill("4");
    await page.getByLabel("Copies along x").press("Enter");
    await page.getByLabel("Copies along z").fill("2");
    await page.getByLabel("Copies along z").press("Enter");
    await page.getByLabel("Distance along x").fill("0.5");
    await page.getByLabel("Distance along x").press("Enter");
    assert.match(await page.getByTestId("array-count").innerText(), /^7 copies/);
    await picture("array");
    await page.getByTestId("array-make").click();
    await page.waitForFunction((count) => window.embody.entities().length === count, ROOM.entities.length + 7);
    const xs = (await session.command("hello")).scene.entities.slice(4).map(({ pose }) => Math.round(100 * pose.position[0]) / 100);
    assert.deepEqual(new Set(xs), new Set([-1, -0.5, 0, 0.5]));
    // They are selected when the answer has come, after the event that draws them.
    await page.waitForFunction(() => window.embody.selection().length === 8);
  });

  it("turns by the wheel with R held, and leaves locked things where they are", async () => {
    await choose(2, 1);
    const at = await page.evaluate(() => window.embody.seenAt(2));
    const turn = async () => (await session.command("hello")).scene.entities[1].pose.rotation ?? [0, 0, 0, 1];
    await page.getByTestId("canvas").focus();
    await page.mouse.move(at.x, at.y);
    await page.keyboard.down("r");
    await page.mouse.wheel(0, 100);
    await until(turn, ([, y]) => Math.abs(Math.abs(y) - Math.sin(Math.PI / 24)) < 1e-6, "turned by 15 degrees");
    await page.keyboard.up("r");
    await page.waitForFunction(() => document.querySelector("[data-testid='tool.select']").getAttribute("aria-pressed") === "true");
    await page.keyboard.press("ArrowRight");
    await page.getByText("Floor is locked and stayed").first().waitFor();
    await until(async () => (await session.command("hello")).scene.entities, (entities) => entities[1].pose.position[0] !== -1 || entities[1].pose.position[2] !== 0, "the box was nudged");
    assert.deepEqual((await session.command("hello")).scene.entities[0].pose.position, [0, -0.1, 0]);
  });
});
