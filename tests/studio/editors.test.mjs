// SPDX-License-Identifier: MIT
// Joints and actions made in the browser, without code: a door on its hinge, and what happens when a key is pressed; real models.
import assert from "node:assert/strict";
import { after, afterEach, before, beforeEach, describe, it } from "node:test";
import { pictured, takePicture } from "./browser.mjs";
import { allDone, Session, until } from "./session.mjs";

const ROOM = {
  embody_scene: 1,
  title: "Editors",
  entities: [
    { index: 1, name: "Floor", category: "floor", locked: true, shape: { type: "box", half_extents: [5, 0.1, 5] }, pose: { position: [0, -0.1, 0] }, attributes: { kind: "static" } },
    { index: 2, name: "Post", shape: { type: "box", half_extents: [0.05, 1, 0.05] }, pose: { position: [-0.55, 1.01, 0] }, attributes: { kind: "static" } },
    { index: 3, name: "Door", shape: { type: "box", half_extents: [0.45, 0.9, 0.03] }, pose: { position: [0, 1.01, 0] } },
    { index: 4, name: "Ball", category: "ball", shape: { type: "sphere", radius: 0.15 }, pose: { position: [1.5, 0.15, 0.8] } },
  ],
  camera: { position: [1.5, 2, 4], target: [0.3, 0.9, 0] },
};

describe("editors of joints and actions in the Studio", { timeout: 900000 }, () => {
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
  async function choose(...indices) {
    for (const [at, index] of indices.entries()) await listed(index).click(at > 0 ? { modifiers: ["Control"] } : {});
    await page.getByTestId("attribute-kind").waitFor();
    await allDone(page);
  }
  const scene = async () => (await session.command("hello")).scene;
  const joint = async () => ((await scene()).joints ?? [])[0];
  const actions = async () => (await scene()).actions ?? [];
  const open = (name) => page.locator("summary", { hasText: name }).click();
  async function type(label, text) {
    await page.getByLabel(label, { exact: true }).fill(text);
    await page.getByLabel(label, { exact: true }).press("Enter");
  }
  // Where a joint is in the world, by the door, which is not turned.
  const anchorOf = ({ frame_b: { position = [0, 0, 0] } }) => position.map((each, axis) => each + ROOM.entities[2].pose.position[axis]);

  it("joins a door to its post, moves the anchor by a click, and sets axis, limits and motor", async () => {
    await choose(2, 3);
    await open("Joints");
    await page.getByTestId("add-joint-hinge").click();
    const made = await until(joint, Boolean, "a joint");
    assert.deepEqual([made.type, made.entity_a, made.entity_b], ["hinge", 2, 3]);
    assert.ok(Math.abs(anchorOf(made)[0] + 0.475) < 1e-6, `between the two: ${anchorOf(made)}`);
    await page.waitForFunction(() => window.embody.joints() === 1);
    await picture("joint");

    await page.getByTestId("pick-anchor").click();
    const at = await page.evaluate(() => window.embody.project(-0.4, 1.5, 0.03));
    await page.mouse.click(at.x, at.y);
    const moved = await until(joint, (each) => Math.abs(anchorOf(each)[1] - 1.5) < 0.03, "the anchor is where the click was");
    assert.ok(Math.abs(anchorOf(moved)[0] + 0.4) < 0.03 && Math.abs(anchorOf(moved)[2] - 0.03) < 0.01, String(anchorOf(moved)));
    assert.deepEqual(await page.evaluate(() => window.embody.selection()), [2, 3], "the click selects nothing else");

    await page.getByTestId("axis-X").click();
    await until(joint, ({ frame_b }) => JSON.stringify(frame_b.rotation ?? [0, 0, 0, 1]) === "[0,0,0,1]", "along X");
    await page.getByTestId("axis-Y").click();
    await until(joint, ({ frame_b }) => Math.abs(frame_b.rotation[2] - Math.SQRT1_2) < 1e-9, "along Y");
    await page.getByLabel("Has limits").check();
    await page.getByLabel("Lower limit, °").waitFor();
    await type("Lower limit, °", "-10");
    await until(joint, ({ limit }) => Math.abs(limit.lower + Math.PI / 18) < 1e-6, "the limit in radians");
    await page.getByLabel("Has a motor").check();
    await page.getByLabel("Motor speed, rad/s").waitFor();
    await type("Motor speed, rad/s", "2");
    await until(joint, ({ motor }) => motor.speed === 2, "the motor's speed");
    await picture("joint_editor");

    // A refusal says why, and nothing is changed.
    await type("Lower limit, °", "200");
    await page.locator(".toast.error, .toast.warning").first().waitFor();
    assert.ok(Math.abs((await joint()).limit.lower + Math.PI / 18) < 1e-6);

    // The motor turns the door.
    await session.command("simulation.step", { count: 90 });
    await page.waitForFunction(() => Math.abs(window.embody.entities().find(({ index }) => index === 3).rotation[1]) > 0.2);
    await session.command("simulation.reset");
    await page.getByTestId(`joint-delete-${made.index}`).click();
    await until(joint, (each) => each === undefined, "deleted");
    await page.getByTestId("canvas").focus();
    await page.keyboard.press("Control+z");
    await until(joint, (each) => each?.motor?.speed === 2, "and brought back");
  });

  it("turns the axis by handles in the picture", async () => {
    await choose(3);
    await open("Joints");
    await page.getByTestId("add-joint-hinge").click();
    const made = await until(joint, Boolean, "a joint to the world");
    assert.equal(made.entity_a, undefined);
    await page.getByTestId("turn-axis").click();
    await page.waitForFunction(() => document.querySelector("[data-testid=turn-axis]").getAttribute("aria-pressed") === "true");
    // The pointer meets the handles once they have been drawn.
    await pictured(page);
    // The outermost ring turns in the plane of the picture; it is found from the outside.
    const at = await page.evaluate(() => window.embody.project(0, 1.01, 0));
    let radius = 140;
    for (; radius > 60; radius -= 2) {
      await page.mouse.move(at.x + radius, at.y);
      if (await page.evaluate(() => window.embody.jointHandle())) break;
    }
    assert.ok(radius > 60, "a ring is under the pointer");
    await page.mouse.down();
    for (let step = 1; step <= 6; ++step) await page.mouse.move(at.x + radius, at.y + 12 * step);
    await page.mouse.up();
    // X of the joint's frame: upwards before, turned a good part of a right angle now.
    const axis = ({ frame_b: { rotation: [x, y, z, w] } }) => [1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y)];
    assert.ok(axis(made)[1] > 0.999);
    const { frame_b, frame_a } = await until(joint, (each) => axis(each)[1] < 0.95, "the axis is turned");
    assert.ok(Math.hypot(...(frame_b.position ?? [0, 0, 0])) < 1e-6, "the anchor stays");
    assert.ok(frame_a);
    await picture("joint_handles");
  });

  it("adds an action from drop-downs, changes, disables, orders and deletes it", async () => {
    await choose(4);
    await open("Actions");
    await page.getByTestId("add-action").click();
    await page.getByTestId("action-dialog").waitFor();
    const sentence = () => page.getByTestId("action-sentence").innerText();
    assert.equal(await sentence(), "When K is pressed, then give Ball a push of 5 N s.");
    await page.getByTestId("action-key").click();
    await page.keyboard.press("j");
    assert.equal(await sentence(), "When J is pressed, then give Ball a push of 5 N s.");
    await page.getByTestId("action-save").click();
    const [first] = await until(actions, ({ length }) => length === 1, "an action");
    assert.deepEqual([first.trigger.key, first.receiver, first.effect.type], ["J", { index: 4 }, "apply_impulse"]);

    // When something touches the ball, its mass becomes another.
    await page.getByTestId("add-action").click();
    await page.getByTestId("trigger").selectOption("contact_begin");
    await page.getByLabel("What it touches").selectOption({ label: "Ball" });
    await page.getByTestId("effect").selectOption("set_attribute");
    await page.getByTestId("action-value").selectOption("restitution");
    await page.getByTestId("action-dialog").getByLabel("Bounciness").fill("0.9");
    await page.getByTestId("action-dialog").getByLabel("Bounciness").press("Enter");
    assert.equal(await sentence(), "When anything touches Ball, then set restitution of Ball to 0.9.");
    await picture("action_dialog");
    await page.getByTestId("action-save").click();
    const [, second] = await until(actions, ({ length }) => length === 2, "two actions");
    assert.deepEqual([second.effect, second.trigger.other], [{ type: "set_attribute", name: "restitution", value: 0.9 }, { index: 4 }]);
    await picture("actions");

    // What the core refuses stays in the dialog, with the reason.
    await page.getByTestId(`action-${first.id}`).click();
    await page.getByTestId("trigger").selectOption("time");
    await page.getByLabel("After, s", { exact: true }).fill("-1");
    await page.getByLabel("After, s", { exact: true }).press("Enter");
    await page.getByTestId("action-save").click();
    await page.locator("[data-testid=action-dialog] .field-error:visible").waitFor();
    await page.getByLabel("After, s", { exact: true }).fill("0.5");
    await page.getByLabel("After, s", { exact: true }).press("Enter");
    await page.getByTestId("action-save").click();
    await until(actions, ([each]) => each.trigger.time === 0.5, "changed");

    await page.getByTestId(`action-enabled-${first.id}`).uncheck();
    await until(actions, ([each]) => each.enabled === false, "disabled");
    await page.getByTestId(`action-down-${first.id}`).click();
    await until(actions, ([each]) => each.effect.type === "set_attribute", "the second is first now");
    await page.getByTestId("action-delete-1").click();
    await until(actions, ({ length }) => length === 1, "deleted");
    await page.getByTestId("canvas").focus();
    await page.keyboard.press("Control+z");
    await until(actions, ({ length }) => length === 2, "and brought back");
  });

  it("tries an action at once, in a run", async () => {
    await session.command("action.add", { name: "Jump", receiver: { index: 4 }, trigger: { type: "time", time: 1000 }, effect: { type: "set_velocity", linear: [0, 8, 0] } });
    await open("Actions");
    // It comes down again: the look for that begins before.
    await Promise.all([page.waitForFunction(() => window.embody.entities().find(({ index }) => index === 4).position[1] > 0.5), page.getByTestId("action-test-1").click()]);
    assert.equal(await page.evaluate(() => window.embody.simulation().state), "playing");
  });
});
