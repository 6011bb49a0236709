// SPDX-License-Identifier: MIT
// Two people in one scene: the real server, two pages of a real browser.
import assert from "node:assert/strict";
import { after, afterEach, before, beforeEach, describe, it } from "node:test";
import { atRest, openStudio } from "./browser.mjs";
import { allDone, Session } from "./session.mjs";

const FLOOR = { index: 1, name: "Floor", shape: { type: "plane", normal: [0, 1, 0], offset: 0 }, attributes: { kind: "static" }, locked: true };
const box = (index, x) => ({ index, name: `Box ${index}`, shape: { type: "box", half_extents: [0.2, 0.2, 0.2] }, pose: { position: [x, 0.2, 0] } });
const ROOM = { embody_scene: 1, title: "Shared room", entities: [FLOOR, box(2, -0.5), box(3, 0.5)], camera: { position: [3, 2.4, 4], target: [0, 0.4, 0] } };

describe("people in a session", { timeout: 900000 }, () => {
  const session = new Session();
  let ann, ben;

  // Each page is a browser of its own, with the name that its user chose.
  const open = (name) =>
    openStudio(session.browser, session.address, {
      prepare: (page) => page.addInitScript((userName) => localStorage.getItem("embody.preferences") ?? localStorage.setItem("embody.preferences", JSON.stringify({ userName, nameAsked: userName !== "" })), name),
    });
  before(() => session.start(ROOM));
  after(() => session.end());
  beforeEach(async () => {
    ann = session.page = await open("Ann");
    await session.command("scene.load", { scene: ROOM });
    ben = await open("Ben Smith");
    // Alone: pages of the test before may leave a moment later.
    for (const [page, other] of [[ann, "Ben Smith"], [ben, "Ann"]])
      await page.waitForFunction((other) => window.embody.people().others.length === 1 && window.embody.people().others[0].name === other, other);
    // Each knows its own name, too.
    for (const page of [ann, ben]) await allDone(page);
  });
  afterEach(async () => {
    for (const page of [ann, ben]) assert.deepEqual(page.faults, []);
    for (const page of [ann, ben]) await page.context().close();
    session.page = null;
  });

  const otherOf = (page) => page.evaluate(() => window.embody.people().others[0]);
  const presenceSeenBy = (page, check) => page.waitForFunction(check);
  const persons = (page) => page.locator("[data-testid=people] .person").allInnerTexts();
  const row = (page, index) => page.locator(`[data-testid=hierarchy] [data-index="${index}"]`);
  async function move(page, index, height) {
    await page.getByTestId("tab-In the scene").click();
    await row(page, index).click();
    await page.getByLabel("Position y", { exact: true }).fill(String(height));
    await page.getByLabel("Position y", { exact: true }).press("Enter");
    for (const each of [ann, ben])
      await each.waitForFunction(([index, height]) => Math.abs(window.embody.entities().find((entity) => entity.index === index).position[1] - height) < 1e-3, [index, height]);
    await page.keyboard.press("Escape");
    await page.getByTestId("canvas").focus();
  }

  it("shows everybody's initials while somebody else is here", async () => {
    assert.deepEqual(await persons(ann), ["A", "BS"]);
    assert.deepEqual(await persons(ben), ["BS", "A"]);
    const { client, color } = await otherOf(ann);
    assert.match(color, /^#[0-9a-f]{6}$/);
    assert.match(await ann.getByTestId(`person-${client}`).getAttribute("title"), /^Ben Smith: look where they look$/);
    await ben.context().close();
    await ann.locator("[data-testid=people] .person").first().waitFor({ state: "detached" });
    ben = await open("Ben Smith");
  });

  it("draws the other's selection in their colour, the point under their mouse and where they look from", async () => {
    const canvas = await ben.getByTestId("canvas").boundingBox();
    await ben.getByTestId("tab-In the scene").click();
    await row(ben, 3).click();
    await ben.mouse.move(canvas.x + canvas.width / 2, canvas.y + canvas.height / 2);
    await ben.mouse.move(canvas.x + canvas.width / 2 + 5, canvas.y + canvas.height / 2, { steps: 2 });
    await presenceSeenBy(ann, () => {
      const { drawn, presence } = window.embody.people().others[0];
      return drawn && presence.selection?.[0] === 3 && presence.pointer && presence.camera && presence.mode === "page";
    });
    const { presence, color } = await otherOf(ann);
    assert.deepEqual(presence.camera, ROOM.camera);

    // In Ann's picture the box has a line of Ben's colour around it: some pixels near the box are just that colour.
    const at = await ann.evaluate(() => window.embody.seenAt(3));
    const close = (picture) =>
      ann.evaluate(
        async ([base64, color]) => {
          const bitmap = await createImageBitmap(new Blob([Uint8Array.from(atob(base64), (character) => character.charCodeAt(0))]));
          const context = new OffscreenCanvas(bitmap.width, bitmap.height).getContext("2d");
          context.drawImage(bitmap, 0, 0);
          const { data } = context.getImageData(0, 0, bitmap.width, bitmap.height);
          const wanted = [1, 3, 5].map((start) => parseInt(color.slice(start, start + 2), 16));
          let found = 0;
          for (let pixel = 0; pixel < data.length; pixel += 4) if (wanted.every((value, channel) => Math.abs(value - data[pixel + channel]) < 30)) ++found;
          return found;
        },
        [picture.toString("base64"), color],
      );
    const shot = async () => {
      await atRest(ann);
      await ann.evaluate(() => window.embody.halt());
      const picture = await ann.screenshot({ clip: { x: at.x - 60, y: at.y - 60, width: 120, height: 120 } });
      await ann.evaluate(() => window.embody.resume());
      return close(picture);
    };
    await ben.mouse.move(canvas.x - 50, canvas.y + 300);
    await presenceSeenBy(ann, () => window.embody.people().others[0].presence.pointer === null);
    const outlined = await shot();
    await ben.getByTestId("canvas").focus();
    await ben.keyboard.press("Escape");
    await presenceSeenBy(ann, () => window.embody.people().others[0].presence.selection.length === 0);
    const plain = await shot();
    assert.ok(outlined > plain + 80, `${outlined} pixels of the colour with the outline, ${plain} without`);
  });

  it("moves the camera to where the other one looks", async () => {
    const canvas = await ben.getByTestId("canvas").boundingBox();
    await ben.mouse.move(canvas.x + 30, canvas.y + 30);
    await ben.mouse.down();
    await ben.mouse.move(canvas.x + 230, canvas.y + 60, { steps: 6 });
    await ben.mouse.up();
    const seen = await ben.evaluate(() => window.embody.camera());
    await ann.waitForFunction((position) => Math.hypot(...window.embody.people().others[0].presence.camera.position.map((at, axis) => at - position[axis])) < 0.01, seen.position);
    const { client } = await otherOf(ann);
    await ann.getByTestId(`person-${client}`).click();
    await ann.waitForFunction((position) => Math.hypot(...window.embody.camera().position.map((at, axis) => at - position[axis])) < 0.01, seen.position);
  });

  it("sends presence at most 15 times a second, and only what has changed", async () => {
    // A third member counts what it is told.
    await ann.evaluate(async () => {
      const socket = new WebSocket(`ws://${location.host}/ws`);
      await new Promise((opened) => (socket.onopen = opened));
      window.received = [];
      socket.onmessage = ({ data }) => typeof data === "string" && JSON.parse(data).event === "presence" && window.received.push(JSON.parse(data));
      socket.send(JSON.stringify({ id: 1, command: "hello", params: { person: "counter" } }));
      window.counter = socket;
    });
    const { client } = await ben.evaluate(() => window.embody.people());
    const received = () => ann.evaluate((client) => window.received.filter((each) => each.client === client), client);
    const forget = () => ann.evaluate(() => void (window.received.length = 0));
    await ben.waitForFunction(() => window.embody.people().others.length === 2);
    await forget();
    const still = JSON.stringify(await ben.evaluate(() => window.embody.camera()));
    const canvas = await ben.getByTestId("canvas").boundingBox();
    const begun = Date.now();
    await ben.mouse.move(canvas.x + 30, canvas.y + 30);
    await ben.mouse.down();
    // For a second at least: on a quick machine the moves alone are over before a third message is due.
    for (let step = 0; step < 60; ++step) {
      await ben.mouse.move(canvas.x + 30 + 2 * step, canvas.y + 30);
      await ben.waitForTimeout(20);
    }
    await ben.mouse.up();
    const seen = await ben.evaluate(() => window.embody.camera());
    // The server tells the last place within a second.
    await ann.waitForFunction(
      ([client, place]) => {
        const last = window.received.findLast((each) => each.client === client && "camera" in each);
        return last && Math.hypot(...last.camera.position.map((each, axis) => each - place[axis])) < 1e-3;
      },
      [client, seen.position],
    );
    const all = await received();
    const seconds = (Date.now() - begun) / 1000;
    // Who is new is told everything, before the first move or with it.
    const told = all.slice(all.findIndex(({ camera }) => camera && JSON.stringify(camera) !== still) + 1);
    assert.ok(told.filter((each) => "camera" in each).length > 2, "the camera is told while it moves");
    assert.ok(told.length <= 15 * seconds + 2, `${told.length} messages in ${seconds} s`);
    assert.ok(told.every((each) => !("selection" in each) && !("mode" in each)), "what has not changed is not sent again");
    await forget();
    await ann.waitForTimeout(700);
    assert.deepEqual(await received(), [], "a page at rest sends nothing");
    await ann.evaluate(() => window.counter.close());
  });

  it("undoes each one's own steps, and says whose change is in the way", async () => {
    await move(ann, 2, 1);
    await move(ben, 3, 2);
    assert.match(await ann.getByTestId("edit.undo").getAttribute("title"), /Box 2/);
    assert.match(await ben.getByTestId("edit.undo").getAttribute("title"), /Box 3/);
    await ann.keyboard.press("Control+z");
    await ben.waitForFunction(() => Math.abs(window.embody.entities().find(({ index }) => index === 2).position[1] - 0.2) < 1e-3);
    assert.ok(Math.abs((await ben.evaluate(() => window.embody.entities().find(({ index }) => index === 3).position[1])) - 2) < 1e-3, "Ben's edit stays");
    await ann.waitForFunction(() => document.querySelector("[data-testid='edit.undo']").disabled);

    await move(ben, 3, 3);
    await move(ann, 3, 4);
    await ben.keyboard.press("Control+z");
    const refused = ben.getByTestId("toast-error");
    await refused.waitFor();
    assert.match(await refused.innerText(), /Ann/, "the reason names who built on it");
    assert.ok(Math.abs((await ann.evaluate(() => window.embody.entities().find(({ index }) => index === 3).position[1])) - 4) < 1e-3);
  });

  it("warns before unsaved work is left only where nobody else is here", async () => {
    const warns = () =>
      ann.evaluate(() => {
        const leaving = new Event("beforeunload", { cancelable: true });
        dispatchEvent(leaving);
        return leaving.defaultPrevented;
      });
    assert.equal(await warns(), false, "nothing is unsaved");
    await move(ann, 2, 1);
    assert.equal(await warns(), false, "Ben keeps the scene open");
    await ben.context().close();
    await ann.waitForFunction(() => window.embody.people().others.length === 0);
    assert.equal(await warns(), true);
    ben = await open("Ben Smith");
  });

  it("draws head and hands of somebody in a headset", async () => {
    await ann.evaluate(async () => {
      const socket = new WebSocket(`ws://${location.host}/ws`);
      await new Promise((opened) => (socket.onopen = opened));
      const send = (id, command, params) => socket.send(JSON.stringify({ id, command, params }));
      send(1, "hello", { person: "headset" });
      const place = (x) => ({ position: [x, 1.2, 0.3], rotation: [0, 0, 0, 1] });
      send(2, "client.present", { mode: "headset", head: { position: [0, 1.6, 0.5], rotation: [0, 0, 0, 1] }, hands: [{ hand: "left", ...place(-0.3) }, { hand: "right", ...place(0.3), holds: 2 }] });
      window.headset = socket;
    });
    await ann.waitForFunction(() => window.embody.people().others.some(({ drawn, presence }) => drawn && presence.head && presence.hands?.length === 2));
    const { client } = (await ann.evaluate(() => window.embody.people().others)).find(({ presence }) => presence.head);
    await ann.getByTestId(`person-${client}`).click();
    await ann.waitForFunction(() => Math.hypot(...window.embody.camera().position.map((at, axis) => at - [0, 1.6, 0.5][axis])) < 0.01);
    await ann.evaluate(() => window.headset.close());
    await ann.waitForFunction(() => window.embody.people().others.length === 1);
  });

  it("is the same person after a reload, and another one in a second tab", async () => {
    await move(ann, 2, 1);
    const person = () => ann.evaluate(() => sessionStorage.getItem("embody.person"));
    const before = await person();
    await ann.reload();
    await ann.waitForFunction(() => window.embody?.connected());
    assert.equal(await person(), before);
    await ann.waitForFunction(() => !document.querySelector("[data-testid='edit.undo']").disabled);
    // The page before may let go of the person a little later.
    await ann.waitForFunction(async (person) => (await navigator.locks.query()).held.some(({ name }) => name.endsWith(person)), before);
    const second = await ann.context().newPage();
    await second.goto(session.address);
    await second.waitForFunction(() => window.embody?.connected());
    assert.notEqual(await second.evaluate(() => sessionStorage.getItem("embody.person")), before);
    assert.ok(await second.getByTestId("edit.undo").isDisabled(), "the other tab's steps are not its own");
    await second.close();
  });

  it("asks the others before another scene is opened, and cancels", async () => {
    const question = ben.getByTestId("card-question");
    // What the card says first: the seconds run while the test looks.
    const first = ben.waitForFunction(() => document.querySelector("[data-testid=question-seconds]")?.textContent);
    await ann.getByTestId("scene.new").click();
    await question.waitFor();
    assert.match(await question.innerText(), /Ann would like to open/);
    assert.match(await (await first).jsonValue(), /^(20|19|18|17) s$/);
    assert.match(await ann.getByTestId("card-waiting").innerText(), /Waiting for Ben Smith/);

    // The message goes by itself.
    await Promise.all([ann.getByText(/Ben Smith would rather go on/).waitFor(), ben.getByTestId("question-refuse").click()]);
    await ann.getByTestId("card-waiting").waitFor({ state: "detached" });
    assert.equal(await ann.evaluate(() => window.embody.entities().length), 3);

    await ann.getByTestId("scene.new").click();
    await question.waitFor();
    await ann.getByTestId("waiting-cancel").click();
    await question.waitFor({ state: "detached" });
    await ann.getByTestId("card-waiting").waitFor({ state: "detached" });

    await ann.getByTestId("scene.new").click();
    await ben.getByTestId("question-agree").click();
    for (const page of [ann, ben]) await page.waitForFunction(() => !window.embody.entities().some(({ name }) => name === "Box 2"));
    await ann.getByTestId("card-waiting").waitFor({ state: "detached" });
  });

  it("asks for a name once, when somebody else is here", async () => {
    const cara = await open("");
    const card = cara.getByTestId("card-name");
    await card.waitFor();
    await cara.getByTestId("name-input").fill("Cara");
    await cara.keyboard.press("Enter");
    await card.waitFor({ state: "detached" });
    await ann.waitForFunction(() => window.embody.people().others.some(({ name }) => name === "Cara"));
    await cara.reload();
    await cara.waitForFunction(() => window.embody?.connected() && window.embody.people().others.length === 2);
    assert.equal(await card.count(), 0);
    await cara.context().close();
  });

  it("asks nobody who is alone", async () => {
    await ben.context().close();
    await ann.context().close();
    const alone = (ann = await open(""));
    // Who left may be gone a moment later.
    await alone.waitForFunction(() => window.embody.people().others.length === 0);
    await alone.waitForTimeout(300);
    assert.equal(await alone.getByTestId("card-name").count(), 0);
    assert.equal(await alone.locator("[data-testid=people] .person").count(), 0);
    ben = await open("Ben Smith");
  });
});
