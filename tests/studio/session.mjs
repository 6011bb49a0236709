// SPDX-License-Identifier: MIT
// What a suite of tests needs: the real program on the real database, a browser, and a page of the Studio.
import assert from "node:assert/strict";
import { openBrowser, openStudio } from "./browser.mjs";
import { findProgram, prepareDatabase, RealServer } from "./real_server.mjs";

/** Commands that the page would be asked about, were they not told to go ahead. */
const ASKING = ["scene.load", "scene.new"];

/** Runs a command of docs/protocol.md as another client of the page's server; returns its result, or an error with the refusal. */
export function commandFrom(page, name, params = {}) {
  const told = ASKING.includes(name) ? { ask: false, ...params } : params;
  return page.evaluate(
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
