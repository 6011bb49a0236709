// SPDX-License-Identifier: MIT
// Changes of the catalogue's models in the Studio: one, all that are found, a category; undo, history, and who did it.
import assert from "node:assert/strict";
import { spawn, spawnSync } from "node:child_process";
import { after, afterEach, before, beforeEach, describe, it } from "node:test";
import { openStudio } from "./browser.mjs";
import { allDone, searchFor as searchOn, Session } from "./session.mjs";

const FLOOR = { name: "Floor", shape: { type: "plane", normal: [0, 1, 0], offset: 0 }, attributes: { kind: "static" } };
const ROOM = { embody_scene: 1, title: "Catalogue room", entities: [FLOOR], camera: { position: [3, 2.4, 4], target: [0, 0.4, 0] } };

describe("changes of the catalogue in the Studio", { timeout: 900000 }, () => {
  const session = new Session();
  let page;
  const others = [];

  before(() => session.start(ROOM));
  after(() => session.end());
  beforeEach(async () => {
    page = await session.reopen();
    await command("scene.load", { scene: ROOM });
    await page.waitForFunction(() => window.embody.entities().length === 1);
    await searchFor("chair");
  });
  afterEach(async () => {
    assert.deepEqual(page.faults, []);
    for (const other of others.splice(0)) await other.context().close();
  });

  // Runs a command as another client of the same server, or another program on the same database, would.
  const command = (name, params) => session.command(name, params);
  function embody(...words) {
    const done = spawnSync(session.program, [...words, "--database", session.server.database], { encoding: "utf8", maxBuffer: 1 << 28 });
    assert.equal(done.status, 0, done.stderr);
    return done.stdout;
  }
  const searchFor = (words) => searchOn(page, words);
  const shownCount = async () => Number((await page.getByTestId("result-count").innerText()).replace(/\D/g, ""));
  const row = (name) => page.getByTestId(`attribute-${name}`);
  const field = (name) => row(name).locator("input").first();
  const preview = () => page.getByTestId("apply-preview");
  const toast = (text) => page.locator(".toast", { hasText: text });
  const value = async (key, name) => (await command("catalog.model", { key })).attributes.find((entry) => entry.name === name);

  async function pick(at = 0) {
    const tile = page.getByTestId("model-tile").nth(at);
    await tile.click();
    await page.getByTestId("model-fields").waitFor();
    await row("mass").waitFor();
    await valuesShown();
    return tile.getAttribute("data-key");
  }
  // Until the values of what is chosen have come, those of the last one are shown.
  const valuesShown = () => allDone(page);
  // What is added is selected when the answer has come, after the event that draws it.
  async function added(count) {
    await page.waitForFunction((count) => window.embody.entities().length === count && window.embody.selection()[0] === window.embody.entities().at(-1).index, count);
    await valuesShown();
  }
  const shows = (mass, at = page) => at.waitForFunction((mass) => document.querySelector("[data-testid=attribute-mass] input").value === mass, mass);
  // A change of a thousand models takes long on a slow machine.
  const LONG = { timeout: 120000 };
  async function openApply(name, scope) {
    // Groups that are closed at first are opened.
    await page.evaluate(() => document.querySelectorAll("details").forEach((each) => (each.open = true)));
    await page.getByTestId(`apply-${name}`).click();
    await page.getByTestId(`apply-scope-${scope}`).check();
  }
  async function confirm(text) {
    await page.getByTestId("apply-confirm").getByText(text).waitFor();
    await page.getByTestId("apply-confirm").click(LONG);
    await page.getByTestId("apply-dialog").waitFor({ state: "detached", ...LONG });
  }
  async function setInDialog(text) {
    const input = page.getByTestId("apply-dialog").locator(".apply-value .field input");
    await input.fill(text);
    await input.press("Tab");
  }

  it("shows unit, interval, source, level and reset of a model's values, as of an entity's", async () => {
    await pick();
    const shown = async () => {
      if ((await page.getByTestId("why-mass").getAttribute("aria-expanded")) === "false") await page.getByTestId("why-mass").click();
      const text = await row("mass").innerText();
      assert.match(text, /kg/, "unit");
      assert.match(text, /\d … \d/, "interval");
      assert.match(await row("mass").locator(".level").getAttribute("aria-label"), /^(sub)?category$|model|measured/);
      assert.ok((await row("mass").locator(".source").innerText()).length > 10, "source");
      for (const source of await page.locator(".attribute[data-testid] .source").allTextContents()) assert.ok(source.length > 3, "each value has a source");
      assert.ok(!(await page.getByTestId("reset-mass").isVisible()));
    };
    await shown();
    const before = await field("mass").inputValue();
    await field("mass").fill("-2");
    await field("mass").press("Enter");
    await row("mass").locator(".field-error").waitFor();
    await field("mass").fill("12.5");
    await field("mass").press("Enter");
    await toast(/^Changed Mass of /).waitFor();
    await row("mass").getByLabel("manual").waitFor();
    assert.equal(await row("mass").locator(".field-error").count(), 0);
    await page.getByTestId("reset-mass").click();
    await page.getByTestId("reset-mass").waitFor({ state: "hidden" });
    assert.equal(await field("mass").inputValue(), before);

    await page.getByTestId("model-add").click();
    await page.getByTestId("entity-fields").waitFor();
    await added(2);
    assert.ok(!(await page.getByTestId("model-fields").isVisible()));
    await shown();
    await field("mass").fill("9");
    await field("mass").press("Enter");
    await page.getByTestId("reset-mass").click();
    await page.getByTestId("reset-mass").waitFor({ state: "hidden" });
    assert.equal(await field("mass").inputValue(), before);
  });

  it("sets a value of all models that are found, updates the other Studio, and undoes and redoes it with keys and button", async () => {
    const other = await openStudio(session.browser, session.address);
    others.push(other);
    await searchOn(other, "chair");
    await other.getByTestId("model-tile").nth(2).click();
    const otherMass = other.locator("[data-testid=attribute-mass] input");
    await otherMass.waitFor();
    const before = await otherMass.inputValue();

    const found = await shownCount();
    await pick();
    await openApply("mass", "found");
    await setInDialog("8.25");
    await preview().getByText(`${found} models change.`).waitFor();
    assert.match(await preview().innerText(), /and \d+ more/);
    assert.match(await preview().innerText(), /Other scenes follow/);
    await page.getByTestId("user-name").fill("Ada");
    await page.getByTestId("user-name").press("Tab");
    await confirm(`Change ${found} models`);
    const done = toast(`Changed Mass of ${found} models`);
    await done.waitFor();
    await other.locator(".toast", { hasText: `Changed Mass of ${found} models, by Ada` }).waitFor();
    await shows("8.25", other);
    await shows("8.25");
    await done.getByTestId("toast-action").click();
    await toast(`Took back Mass of ${found} models`).waitFor();
    await shows(before, other);
    // The act and its undo. Asked only now: the message with its button goes after a while.
    assert.match(embody("history", "--limit", String(2 * found)), /\(studio: Ada\).*models found by "chair"[\s\S]*automatic → 8.25/);
    await row("mass").getByLabel("manual").waitFor({ state: "detached" });
    await page.keyboard.press("Control+Shift+Z");
    await shows("8.25");
    await page.keyboard.press("Control+z");
    await row("mass").getByLabel("manual").waitFor({ state: "detached" });
    assert.equal((await value(await page.getByTestId("model-tile").nth(2).getAttribute("data-key"), "mass")).overridden, false);

    // The name is stored in the browser.
    await page.reload();
    await page.waitForFunction(() => window.embody?.connected());
    await page.getByTestId("view.options").click();
    assert.equal(await page.getByTestId("user-name").inputValue(), "Ada");
  });

  it("takes back scene and catalogue in the order in which things were done", async () => {
    const key = await pick();
    await page.getByTestId("model-add").click();
    await added(2);
    await openApply("mass", "model");
    await setInDialog("31");
    await preview().getByText("1 thing in this scene follows at once.").waitFor();
    await confirm("Change 1 model");
    await shows("31");
    assert.match(await page.getByTestId("edit.undo").getAttribute("title"), /Undo: Set Mass of/);
    await page.keyboard.press("Delete");
    await page.waitForFunction(() => window.embody.entities().length === 1);
    await page.keyboard.press("Control+z");
    await page.waitForFunction(() => window.embody.entities().length === 2);
    assert.equal((await value(key, "mass")).value, 31);
    await page.keyboard.press("Control+z");
    await toast(/^Took back Mass of/).waitFor();
    assert.equal((await value(key, "mass")).overridden, false);
    assert.equal(await page.evaluate(() => window.embody.entities().length), 2);
    await page.keyboard.press("Control+z");
    await page.waitForFunction(() => window.embody.entities().length === 1);
  });

  it("changes a category from an entity, names what refuses, and leaves the values of single entities", async () => {
    await pick();
    for (let copy = 0; copy < 2; ++copy) {
      await searchFor("chair");
      await page.getByTestId("model-tile").first().dblclick();
      await added(copy + 2);
    }
    await field("mass").fill("50");
    await field("mass").press("Enter");
    // Its source is folded until it is asked for.
    await row("mass").getByText("set for this entity").waitFor({ state: "attached" });
    await openApply("mass", "category");
    await setInDialog("7");
    await preview().getByText("1 thing in this scene follows at once. 1 thing has a value of its own and keeps it.").waitFor();
    await confirm(/Change \d+ models/);
    await toast(/^Changed Mass of \d+ models/).waitFor();
    assert.equal(await field("mass").inputValue(), "50");
    const [kept, following] = await page.evaluate(() => window.embody.entities().slice(1).map(({ index }) => index).reverse());
    const massOf = async (index) => (await command("entity.attributes", { index })).attributes.find(({ name }) => name === "mass").value;
    assert.deepEqual([await massOf(kept), await massOf(following)], [50, 7]);
    await page.getByTestId("canvas").focus();
    await page.keyboard.press("Control+z");
    await toast(/^Took back Mass of/).waitFor();

    // Of all models, the soft and fluid ones have no wall.
    await page.getByTestId("search").fill("");
    await page.waitForFunction(() => Number(document.querySelector("[data-testid=result-count]").textContent.replace(/\D/g, "")) > 500);
    await openApply("wall_thickness", "found");
    await setInDialog("0.004");
    await preview().getByText(/models cannot have it, so nothing would be changed/).waitFor(LONG);
    await preview().getByText(/does not concern things of the kind/).first().waitFor();
    assert.ok(await page.getByTestId("apply-confirm").isDisabled());
    await page.getByTestId("apply-skip").check();
    await preview().getByText(/models cannot have it and stay as they are/).waitFor(LONG);
    await confirm(/Change \d+ models/);
    await toast(/^Changed Wall thickness of \d+ models/).getByTestId("toast-action").click();
    await toast(/^Took back Wall thickness/).waitFor(LONG);
  });

  it("offers the value without the scale of a scaled entity", async () => {
    const key = await pick();
    const mass = (await value(key, "mass")).value;
    await page.getByTestId("model-add").click();
    await added(2);
    await page.getByRole("textbox", { name: "Scale" }).fill("2");
    await page.getByRole("textbox", { name: "Scale" }).press("Enter");
    await page.waitForFunction((mass) => Math.abs(Number(document.querySelector("[data-testid=attribute-mass] input").value) / mass - 8) < 1e-3, mass);
    await page.getByTestId("apply-mass").click();
    await page.getByText("The value without the entity's scale").waitFor();
    const shown = Number(await page.getByTestId("apply-dialog").locator(".apply-value .field input").inputValue());
    assert.ok(Math.abs(shown / mass - 1) < 1e-3, `${shown} of ${mass} kg`);
    await page.getByTestId("apply-cancel").click();
  });

  it("lists who changed what, undoes one act of many, and says why one can't be undone", async () => {
    const key = await pick(1);
    embody("set", key, "mass=21");
    await toast(/by command line/).waitFor();
    await shows("21");
    embody("set", key, "mass=22");
    await shows("22");
    await page.getByTestId("model-history").click();
    const list = page.getByTestId("history");
    await list.getByText("21 kg → 22 kg").waitFor();
    await list.getByText("automatic → 21 kg").waitFor();
    assert.match(await list.innerText(), /command line/);

    // The newer batch has changed the older one's value, so the older one cannot be undone.
    const acts = list.locator("> li");
    await acts.nth(1).getByRole("button", { name: "Undo" }).click();
    await acts.nth(1).getByText(/nothing was undone: the Mass of .* was changed since/).waitFor();
    await acts.nth(0).getByRole("button", { name: "Undo" }).click();
    await list.getByText("22 kg → 21 kg").waitFor();
    assert.match(await acts.nth(1).getAttribute("class"), /undone/);
    assert.equal((await value(key, "mass")).value, 21);
    // An undo can be taken back.
    await acts.nth(0).getByRole("button", { name: "Redo" }).click();
    await page.waitForFunction(() => document.querySelector("[data-testid=history] > li")?.innerText.includes("21 kg → 22 kg"));
    assert.equal((await value(key, "mass")).value, 22);
  });

  it("loses nothing when two Studios and the command line change the same models at once", async () => {
    const other = await openStudio(session.browser, session.address);
    others.push(other);
    const rounds = 4;
    const change = (of, mass) =>
      of.evaluate(
        async ([mass, rounds]) => {
          const socket = new WebSocket(`ws://${location.host}/ws`);
          await new Promise((opened) => (socket.onopen = opened));
          let answered = 0;
          const done = new Promise((all) => {
            socket.onmessage = ({ data }) => {
              if (typeof data !== "string" || !("ok" in JSON.parse(data))) return;
              if (!JSON.parse(data).ok) throw new Error(data);
              if (++answered === rounds) all();
            };
          });
          for (let round = 0; round < rounds; ++round)
            socket.send(JSON.stringify({ id: round, command: "catalog.change", params: { models: { words: "chair" }, attributes: [{ name: "mass", value: mass + round }] } }));
          await done;
          socket.close();
        },
        [mass, rounds],
      );
    const commandLine = async (mass) => {
      for (let round = 0; round < rounds; ++round) {
        const set = spawn(session.program, ["set", "--query", "chair", `mass=${mass + round}`, "--database", session.server.database]);
        let told = "";
        for (const stream of [set.stdout, set.stderr]) stream.on("data", (data) => (told += data));
        const ended = await new Promise((end) => set.on("close", (code, signal) => end(signal ?? code)));
        assert.equal(ended, 0, told);
      }
    };
    const newest = (await command("catalog.history", { limit: 1 })).batches[0]?.batch ?? 0;
    await Promise.all([change(page, 100), change(other, 200), commandLine(300)]);
    const { changes } = JSON.parse(embody("history", "--limit", "100000", "--json"));
    const present = new Map();
    const acts = new Set();
    for (const { batch, key, attribute, before, after } of changes.reverse()) {
      if (attribute !== "mass") continue;
      if (present.has(key)) assert.equal(before, present.get(key), `batch ${batch} found what the one before it left`);
      present.set(key, after);
      if (batch > newest) acts.add(batch);
    }
    assert.equal(acts.size, 3 * rounds);
    for (const key of [...present.keys()].slice(0, 5)) assert.equal((await value(key, "mass")).value, present.get(key));
  });

  it("goes back to the automatic values of many", async () => {
    embody("set", "--query", "chair", "mass=3");
    await pick();
    await shows("3");
    await openApply("mass", "found");
    await page.getByTestId("apply-reset").check();
    await confirm(/Change \d+ models/);
    await toast(/^Reset Mass of \d+ models/).waitFor();
    await row("mass").getByLabel("manual").waitFor({ state: "detached" });
  });

  it("lists a model under its new category once that has changed", async () => {
    const before = await shownCount();
    await page.getByTestId("category").selectOption("chair");
    await page.waitForFunction((count) => Number(document.querySelector("[data-testid=result-count]").textContent.replace(/\D/g, "")) < count, before);
    const chairs = await shownCount();
    const key = await pick();
    await field("category").fill("table");
    await field("category").press("Enter");
    await page.waitForFunction((count) => Number(document.querySelector("[data-testid=result-count]").textContent.replace(/\D/g, "")) === count, chairs - 1);
    assert.equal(await page.locator(`[data-key="${key}"]`).count(), 0);
    await toast(/^Changed Category/).getByTestId("toast-action").click();
    await page.waitForFunction((count) => Number(document.querySelector("[data-testid=result-count]").textContent.replace(/\D/g, "")) === count, chairs);
  });
});
