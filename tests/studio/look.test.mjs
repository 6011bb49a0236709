// SPDX-License-Identifier: MIT
// How the scene looks: levels of detail beside full detail, what is picked then, contact shadows, sky, lamps, finishes.
import assert from "node:assert/strict";
import { after, before, test } from "node:test";
import { brightness, difference, pictured, pictureOfScene } from "./browser.mjs";
import { Session } from "./session.mjs";

const session = new Session();
const floor = { index: 1, name: "Floor", shape: { type: "plane" } };

before(() => session.start({ embody_scene: 1, title: "Look", entities: [floor] }));
after(() => session.end());

/** Keys of real models, the heaviest of some hundred first. */
async function heavyModels(count) {
  const { models } = await session.command("catalog.search", { words: "", limit: 200 });
  return models.filter(({ size }) => Math.max(...size) < 3).sort((a, b) => b.triangles - a.triangles).slice(0, count).map(({ key }) => key);
}

async function open(entities, camera, options) {
  await session.command("scene.load", { scene: { embody_scene: 1, title: "Look", camera, entities: [floor, ...entities] } });
  const page = await session.reopen(options);
  await page.waitForFunction((count) => window.embody.entities().filter(({ drawn }) => drawn).length === count, entities.length + 1, { timeout: 120000 });
  await pictured(page);
  return page;
}

test("levels of detail look like full detail, and rays meet full detail", async () => {
  await session.reopen();
  const keys = await heavyModels(12);
  const entities = keys.map((model, at) => ({ index: at + 2, model, pose: { position: [2 * (at % 4) - 3, 0, -2 * Math.floor(at / 4)] } }));
  const page = await open(entities, { position: [0, 2.4, 9], target: [0, 0.5, -2] });
  const levels = () => page.evaluate((count) => Array.from({ length: count }, (_, at) => window.embody.levelOf(at + 2)), entities.length);
  const coarse = await pictureOfScene(page);
  const coarseTriangles = await page.evaluate(() => window.embody.drawn().triangles);
  assert.ok((await levels()).every((level) => level > 0), "all are drawn on coarser levels from here");
  const middles = await page.evaluate((count) => Array.from({ length: count }, (_, at) => window.embody.seenAt(at + 2)), entities.length);
  const pickAll = () => page.evaluate((places) => places.map(({ x, y }) => window.embody.pick(x, y)), middles);
  const picked = await pickAll();

  await page.evaluate(() => window.embody.showFullDetail(true));
  const full = await pictureOfScene(page);
  const fullTriangles = await page.evaluate(() => window.embody.drawn().triangles);
  assert.ok((await levels()).every((level) => level === 0));
  assert.ok(coarseTriangles < fullTriangles / 3, `${coarseTriangles} of ${fullTriangles} triangles`);
  const different = await difference(page, coarse, full);
  assert.ok(different < 0.01, `${different} of the picture differs`);
  assert.deepEqual(picked, await pickAll());
  assert.deepEqual(page.faults, []);
});

test("leaves and lampshades are there on all levels of detail", async () => {
  const keys = ["Blend Swap CC-0#plant", "Scopia#livingroom_lamp1", "Blend Swap CC-0#littlePlant"];
  const entities = keys.map((key, at) => ({ index: at + 2, model: `sweethome3d:${key}`, pose: { position: [at - 1, 0, 0] } }));
  const page = await open(entities, { position: [0, 1.5, 5], target: [0, 0.4, 0] });
  const coarse = await pictureOfScene(page);
  await page.evaluate(() => window.embody.showFullDetail(true));
  const different = await difference(page, coarse, await pictureOfScene(page));
  assert.ok(different < 0.003, `${different} of the picture differs`);
});

test("trees are thinned out from afar and look as before", async () => {
  const keys = ["japaneseMaple", "poplar", "peachBlossom", "ficusTree"];
  const entities = keys.map((key, at) => ({ index: at + 2, model: `sweethome3d:Scopia#${key}`, pose: { position: [9 * at - 13, 0, 0] } }));
  const page = await open(entities, { position: [0, 4, 75], target: [0, 4, 0] });
  const coarse = await pictureOfScene(page);
  const coarseTriangles = await page.evaluate(() => window.embody.drawn().triangles);
  await page.evaluate(() => window.embody.showFullDetail(true));
  const full = await pictureOfScene(page);
  const fullTriangles = await page.evaluate(() => window.embody.drawn().triangles);
  assert.ok(coarseTriangles < fullTriangles / 4, `${coarseTriangles} of ${fullTriangles} triangles`);
  await session.command("entity.remove", { indices: entities.map(({ index }) => index) });
  await page.waitForFunction(() => window.embody.entities().length === 1);
  const empty = await pictureOfScene(page);
  const [different, filled] = [await difference(page, coarse, full), await difference(page, full, empty)];
  assert.ok(different < 0.35 * filled, `${different / filled} of the trees' pixels differ`);
  const covered = await difference(page, coarse, empty);
  assert.ok(Math.abs(covered / filled - 1) < 0.1, `${covered / filled} of the pixels are covered`);
});

test("cloth is drawn in the detail that it needs, and not where it is out of view", async () => {
  const curtain = (index, position) => ({ index, model: "sweethome3d:eTeks#curtains", pose: { position } });
  const page = await open([curtain(2, [0, 0.5, 0]), curtain(3, [0, 0.5, 30]), curtain(4, [0, 0.5, -25])], { position: [0, 1.5, 2.2], target: [0, 1.5, 0] });
  const levels = () => page.evaluate(() => [2, 3, 4].map((index) => window.embody.levelOf(index)));
  await page.waitForFunction(() => [2, 3, 4].every((index) => window.embody.bent(index) !== null));
  await pictured(page);
  const [near, behind, far] = await levels();
  assert.equal(near, 0);
  assert.equal(behind, -1);
  // A level finer where the picture stood still before it was asked for.
  assert.ok(far >= 1, `level ${far} at 27 m`);
});

test("what is out of view is not drawn, and can be met by a ray", async () => {
  const box = (index, x) => ({ index, shape: { type: "box", half_extents: [0.5, 0.5, 0.5] }, pose: { position: [x, 0.5, 0] } });
  const page = await open([box(2, 0), box(3, 40)], { position: [0, 2, 6], target: [0, 0.5, 0] });
  assert.deepEqual(await page.evaluate(() => [2, 3].map((index) => window.embody.levelOf(index))), [0, -1]);
  await session.command("entity.transform", { poses: [{ index: 3, position: [1.2, 0.5, 0] }] });
  await page.waitForFunction(() => window.embody.levelOf(3) === 0);
});

test("contact shadows lie on what is below, follow, fade with height and go", async () => {
  const box = (index, half, position) => ({ index, shape: { type: "box", half_extents: half }, pose: { position } });
  const table = box(2, [0.6, 0.4, 0.4], [0, 0.4, 0]);
  const cup = box(3, [0.05, 0.05, 0.05], [0, 0.85, 0]);
  const stool = box(4, [0.2, 0.2, 0.2], [1.5, 0.2, 0]);
  const page = await open([table, cup, stool], { position: [0, 2, 5], target: [0, 0.5, 0] });
  const shadow = (index) => page.evaluate((index) => window.embody.contactShadow(index), index);
  await page.waitForFunction(() => [2, 3, 4].every((index) => window.embody.contactShadow(index)?.darkness > 0.9));
  assert.ok(Math.abs((await shadow(3)).height - 0.8) < 1e-3, "the cup's lies on the table");
  assert.ok(Math.abs((await shadow(4)).height) < 1e-3, "the stool's lies on the floor");

  await session.command("entity.transform", { poses: [{ index: 4, position: [1.5, 0.5, 0] }] });
  await page.waitForFunction(() => window.embody.contactShadow(4)?.darkness < 0.5);
  assert.ok((await shadow(4)).darkness > 0.1);
  // The table goes from under the cup: nothing is left to be dark below it.
  await session.command("entity.transform", { poses: [{ index: 2, position: [-3, 0.4, 0] }] });
  await page.waitForFunction(() => window.embody.contactShadow(3) === null);
  await session.command("entity.remove", { indices: [2] });
  await page.waitForFunction(() => window.embody.contactShadow(2) === null);
  assert.deepEqual(page.faults, []);
});

test("the sky follows the time of day, which is an edit that undo takes back", async () => {
  const box = { index: 2, shape: { type: "box", half_extents: [0.4, 0.4, 0.4] }, pose: { position: [0, 0.4, 0] } };
  const page = await open([box], { position: [0, 1.6, 5], target: [0, 0.8, 0] });
  const hour = () => page.evaluate(() => window.embody.light().hour);
  const reaches = (wanted) => page.waitForFunction((wanted) => window.embody.light().hour === wanted, wanted);
  assert.equal(await hour(), null);
  await page.getByLabel("Sky").check();
  await reaches(14);
  const day = await brightness(page, await pictureOfScene(page));
  await page.getByTestId("time-of-day").fill("23");
  await reaches(23);
  const night = await brightness(page, await pictureOfScene(page));
  assert.ok(night < day / 2, `${night} by night, ${day} by day`);
  await page.getByTestId("edit.undo").click();
  await reaches(14);
  await page.getByTestId("edit.undo").click();
  await reaches(null);
  await assert.rejects(session.command("scene.settings", { time_of_day: 25 }), /time_of_day.*24/);
  assert.deepEqual(page.faults, []);
});

test("a lamp that is switched on in the panel lights what is around it", async () => {
  const lamp = { index: 2, name: "Lamp", shape: { type: "cylinder", radius: 0.1, half_height: 0.5 }, pose: { position: [0, 0.5, 0] } };
  const page = await open([lamp], { position: [0, 2, 4], target: [0, 0.4, 0] });
  await session.command("scene.settings", { sky: true, time_of_day: 0 });
  await page.waitForFunction(() => window.embody.light().hour === 0);
  const { x, y } = await page.evaluate(() => window.embody.seenAt(2));
  await page.mouse.click(x, y);
  await page.waitForFunction(() => window.embody.selection().includes(2));
  const dark = await brightness(page, await pictureOfScene(page));
  await page.getByTestId("look-fields").getByLabel("Light").check();
  await page.waitForFunction(() => window.embody.light().on.includes(2) && window.embody.light().shining === 1);
  const lit = await brightness(page, await pictureOfScene(page));
  assert.ok(lit > dark + 3, `${lit} with the lamp, ${dark} without`);
  await session.command("entity.update", { index: 2, entity: { light: { on: false } } });
  await page.waitForFunction(() => window.embody.light().on.length === 0);
  assert.deepEqual(page.faults, []);
});

test("a finish is drawn over the colour", async () => {
  const slab = { index: 2, shape: { type: "box", half_extents: [3, 0.05, 3] }, color: [0.5, 0.35, 0.2], pose: { position: [0, 0.05, 0] } };
  const page = await open([slab], { position: [0, 3, 3], target: [0, 0, 0] });
  const plain = await pictureOfScene(page);
  await session.command("entity.update", { index: 2, entity: { finish: "parquet" } });
  await page.waitForFunction(() => window.embody.entities().some(({ index, drawn }) => index === 2 && drawn));
  assert.ok((await difference(page, plain, await pictureOfScene(page))) > 0.03);
  await assert.rejects(session.command("entity.update", { index: 2, entity: { finish: "velvet" } }), /must be one of plain, parquet/);
  assert.deepEqual(page.faults, []);
});
