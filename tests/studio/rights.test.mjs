// SPDX-License-Identifier: MIT
// Guests who may look, run or build: the real server on an address for others, a page for each person.
import assert from "node:assert/strict";
import { after, before, describe, it } from "node:test";
import { openStudio, takePicture } from "./browser.mjs";
import { Session } from "./session.mjs";

const FLOOR = { index: 1, name: "Floor", shape: { type: "plane", normal: [0, 1, 0], offset: 0 }, attributes: { kind: "static" }, locked: true };
const BOX = { index: 2, name: "Box", shape: { type: "box", half_extents: [0.3, 0.3, 0.3] }, pose: { position: [0, 0.3, 0] } };
const ROOM = { embody_scene: 1, title: "Room with guests", entities: [FLOOR, BOX], camera: { position: [2, 2, 3], target: [0, 0.3, 0] } };

describe("what guests may do", { timeout: 900000 }, () => {
  const session = new Session();
  const faults = [];
  let host, invited;

  before(async () => {
    await session.start(ROOM, ["--address", "0.0.0.0"]);
    host = session.page = await open(session.address, "Ann");
    await host.getByTestId("people-open").click();
    await host.getByTestId("people-dialog").waitFor();
    invited = {};
    for (const kind of ["build", "run", "look"]) invited[kind] = await host.getByTestId(`invite-${kind}`).locator("input").first().inputValue();
    await host.keyboard.press("Escape");
  });
  after(() => session.end());

  // The addresses are of this machine's network; a test stays at home.
  async function open(address, userName) {
    const url = new URL(address);
    url.hostname = "127.0.0.1";
    const page = await openStudio(session.browser, url.href, { prepare: (page) => page.addInitScript((userName) => localStorage.setItem("embody.preferences", JSON.stringify({ userName, nameAsked: true })), userName) });
    page.on("close", () => faults.push(...page.faults));
    return page;
  }
  const heightIn = (page) => page.evaluate(() => window.embody.entities().find(({ name }) => name === "Box")?.position[1]);
  const selectBox = async (page) => {
    const at = await page.evaluate(() => window.embody.seenAt(2));
    await page.mouse.click(at.x, at.y);
    await page.waitForFunction(() => window.embody.selection().includes(2));
    return at;
  };

  it("gives three addresses that differ in their token", () => {
    const tokens = Object.values(invited).map((url) => new URL(url).searchParams.get("token"));
    assert.equal(new Set(tokens).size, 3);
    assert.equal(tokens[0], new URL(session.address).searchParams.get("token"), "the first is the host's own");
  });

  it("lets a guest look and neither move, delete nor play", async () => {
    const guest = await open(invited.look, "Ben");
    assert.equal(await guest.getByTestId("may").innerText(), "You may look");
    const at = await selectBox(guest);
    for (const id of ["simulation.play", "simulation.step", "edit.delete", "scene.new"]) assert.ok(await guest.getByTestId(id).isDisabled(), id);
    await guest.keyboard.press("Delete");
    await guest.keyboard.press("Space");
    const camera = JSON.stringify(await guest.evaluate(() => window.embody.camera()));
    await guest.mouse.move(at.x, at.y);
    await guest.mouse.down();
    await guest.mouse.move(at.x + 90, at.y + 20, { steps: 6 });
    await guest.mouse.up();
    assert.notEqual(JSON.stringify(await guest.evaluate(() => window.embody.camera())), camera, "a drag turns the camera");
    // What the page does not hold back, the core refuses.
    await guest.getByLabel("Position y", { exact: true }).fill("2");
    await guest.getByLabel("Position y", { exact: true }).press("Enter");
    await guest.getByText("you may look, but neither edit nor run the scene").first().waitFor();
    assert.ok(Math.abs((await heightIn(host)) - 0.3) < 1e-6);
    assert.equal(await host.evaluate(() => window.embody.simulation().state), "stopped");
    if (process.env.EMBODY_TEST_PICTURES) await takePicture(guest, `${process.env.EMBODY_TEST_PICTURES}/guest.png`);
    await guest.context().close();
  });

  it("lets the host give a guest more, at once and for the next visit", async () => {
    const guest = await open(invited.run, "Cara");
    assert.equal(await guest.getByTestId("may").innerText(), "You may look and play");
    assert.ok(await guest.getByTestId("simulation.play").isEnabled());
    assert.ok(await guest.getByTestId("simulation.keep").isDisabled());
    await host.waitForFunction(() => window.embody.people().others.some(({ name }) => name === "Cara"));
    const { client } = (await host.evaluate(() => window.embody.people().others)).find(({ name }) => name === "Cara");
    await host.getByTestId("people-open").click();
    if (process.env.EMBODY_TEST_PICTURES) await takePicture(host, `${process.env.EMBODY_TEST_PICTURES}/people.png`);
    // The message goes by itself.
    await Promise.all([guest.getByText("Ann: you may edit and run the scene").waitFor(), host.getByTestId(`rights-${client}`).selectOption({ label: "may build and play" })]);
    await guest.getByTestId("may").waitFor({ state: "detached" });
    await host.keyboard.press("Escape");
    await selectBox(guest);
    await guest.getByLabel("Position y", { exact: true }).fill("1.5");
    await guest.getByLabel("Position y", { exact: true }).press("Enter");
    await host.waitForFunction(() => Math.abs(window.embody.entities().find(({ name }) => name === "Box").position[1] - 1.5) < 1e-6);
    // Kept for the person, who comes by the same address.
    await guest.reload();
    await guest.waitForFunction(() => window.embody?.connected() && window.embody.people().others.length === 1);
    assert.equal(await guest.getByTestId("may").count(), 0);
    assert.ok(await guest.getByTestId("scene.new").isEnabled());
    await guest.context().close();
  });

  it("shows no faults", async () => {
    await host.context().close();
    // A command that is refused by an HTTP status would be one.
    assert.deepEqual(faults, []);
  });
});
