// SPDX-License-Identifier: MIT
// What a suite of tests needs: the real program on the real database, a browser, and a page of the Studio.
import assert from "node:assert/strict";
import { openBrowser, openStudio } from "./browser.mjs";
import { findProgram, prepareDatabase, RealServer } from "./real_server.mjs";

/** Commands that the page would be asked about, were they not told to go ahead. */
const ASKING = ["scene.load", "scene.new"];

/**
 * Runs a command of docs/protocol.md as another client of the page's server, and waits until all pages of the browser have heard
 * of what it did: a test that goes on before would find the old scene. Returns the command's result, or an error with the refusal.
 */
export async function commandFrom(page, name, params = {}) {
  const told = ASKING.includes(name) ? { ask: false, ...params } : params;
  const result = await page.evaluate(
    async ([command, params]) => {
      const socket = new WebSocket(`ws://${location.host}/ws`);
      await new Promise((opened) => (socket.onopen = opened));
      socket.send(JSON.stringify({ id: 1, command, params }));
      const reply = await new Promise((got) => {
        socket.onmessage = (event) => typeof event.data === "string" && "ok" in JSON.parse(event.data) && got(JSON.parse(event.data));
      });
      socket.close();
      if (!reply.ok) throw new Error(JSON.stringify(reply.error));
      return reply.result;
    },
    [name, told],
  );
  const pages = page.context().browser().contexts().flatMap((context) => context.pages());
  await Promise.all(pages.map((each) => each.evaluate(() => window.embody?.connected() && window.embody.caughtUp())));
  return result;
}

/** Waits until the server has carried out all that the page asks of it, also what the page sends only after an answer. */
export function allDone(page) {
  return page.evaluate(async () => {
    for (let round = 0; round < 4; ++round) await window.embody.caughtUp();
  });
}

/**
 * The same, and until the panels show what came of it: after an edit the page fills the list of things anew (80 ms), asks for
 * warnings (250 ms), and for values after these (60 ms). Timers of a page end in their order, however slow it is.
 */
export function settled(page) {
  return page.evaluate(async () => {
    for (const ms of [0, 0, 300, 100, 0]) {
      await window.embody.caughtUp();
      await new Promise((done) => setTimeout(done, ms));
    }
  });
}

/** Searches for models, and waits until the tiles are those of this search. */
export async function searchFor(page, words) {
  await page.getByTestId("search").fill(words);
  await page.waitForFunction((word) => {
    const grid = document.querySelector("[data-testid=model-grid]");
    return grid.getAttribute("aria-busy") === "false" && grid.querySelector("[data-testid=model-tile]")?.getAttribute("aria-label")?.toLowerCase().includes(word);
  }, words);
}

/** Reads again and again until it fits, at most `limit` ms, by default as long as Playwright waits for a page; the last that was read. */
export async function until(read, fits, message, limit = 30000) {
  let last;
  for (const begun = Date.now(); Date.now() - begun < limit; await new Promise((done) => setTimeout(done, 50))) {
    last = await read();
    if (fits(last)) return last;
  }
  assert.fail(`${message}: ${JSON.stringify(last)}`);
}

/** One server and one browser for all tests of a suite. */
export class Session {
  page = null;

  /** Starts the program with a scene (the document itself) and more words. */
  async start(scene, more = []) {
    this.program = findProgram();
    assert.ok(this.program, "the program embody is not built: build it, or set EMBODY_PROGRAM");
    this.server = new RealServer(this.program, prepareDatabase(this.program));
    this.address = await this.server.start(scene, more);
    this.browser = await openBrowser();
  }

  /** A new page in place of the last one. */
  async reopen(options) {
    await this.page?.context().close();
    this.page = await openStudio(this.browser, this.address, options);
    return this.page;
  }

  command(name, params) {
    return commandFrom(this.page, name, params);
  }

  async end() {
    await this.browser?.close();
    await this.server?.discard();
  }
}
