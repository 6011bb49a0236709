// SPDX-License-Identifier: MIT
// What the server allows a browser to do with its pages (docs/protocol.md, "Who is answered"): the Studio runs under its own strict
// policy without a violation, and pages of other sites receive nothing.
import assert from "node:assert/strict";
import { createServer } from "node:http";
import { after, before, describe, it } from "node:test";
import { openBrowser, openStudio } from "./browser.mjs";
import { boxGlb } from "./models.mjs";
import { findProgram, RealServer } from "./real_server.mjs";

// Each kind is drawn by other code: instances, the surface of a liquid by a worker, cloth.
const SCENE = {
  embody_scene: 1,
  title: "Policy",
  entities: [
    { index: 1, shape: { type: "plane" }, attributes: { kind: "static" } },
    { index: 2, shape: { type: "box", half_extents: [0.2, 0.2, 0.2] }, pose: { position: [0, 0.3, 0] } },
    { index: 3, shape: { type: "box", half_extents: [0.1, 0.1, 0.1] }, pose: { position: [1, 0.2, 0] }, attributes: { kind: "fluid" } },
    { index: 4, shape: { type: "box", half_extents: [0.3, 0.005, 0.3] }, pose: { position: [-1, 0.5, 0] }, attributes: { kind: "cloth" } },
  ],
};

describe("the server's policy for browsers", { timeout: 900000 }, () => {
  let server, browser, address;

  before(async () => {
    const program = findProgram();
    assert.ok(program, "the program embody is not built: build it, or set EMBODY_PROGRAM");
    server = new RealServer(program, "");
    address = await server.start(SCENE);
    browser = await openBrowser();
  });
  after(async () => {
    await browser?.close();
    await server?.discard();
  });

  it("has no violation while the Studio imports, draws and plays", async () => {
    const prepare = (page) =>
      page.addInitScript(() => {
        window.violations = [];
        document.addEventListener("securitypolicyviolation", (event) => window.violations.push(`${event.violatedDirective}: ${event.blockedURI}`));
      });
    const page = await openStudio(browser, address, { quality: "high", prepare });
    await page.evaluate(async (bytes) => {
      const canvas = document.querySelector("canvas").getBoundingClientRect();
      const data = new DataTransfer();
      data.items.add(new File([new Uint8Array(bytes)], "box.glb"));
      const place = { clientX: canvas.left + canvas.width / 2, clientY: canvas.top + canvas.height * 0.6, bubbles: true, cancelable: true };
      document.querySelector("canvas").dispatchEvent(new DragEvent("drop", { dataTransfer: data, ...place }));
    }, [...boxGlb({ textured: true })]);
    await page.waitForFunction(() => window.embody.entities().some((entity) => entity.model && entity.drawn), null, { timeout: 60000 });
    await page.getByTestId("model-tile").first().waitFor();
    await page.keyboard.press("Space");
    await page.waitForTimeout(2000);
    assert.deepEqual(await page.evaluate(() => window.violations), []);
    assert.deepEqual(page.faults, []);
    // The policy is in force: other actions than the Studio's are refused.
    const refused = await page.evaluate(() => {
      const script = document.createElement("script");
      script.textContent = "window.intruded = true";
      document.head.append(script);
      return { intruded: window.intruded === true };
    });
    assert.deepEqual(refused, { intruded: false });
    await page.context().close();
  });

  it("gives a page of another site neither pictures nor frames nor sockets", async () => {
    const stranger = createServer((_, response) => response.writeHead(200, { "content-type": "text/html" }).end("<!doctype html><p>Elsewhere"));
    await new Promise((listens) => stranger.listen(0, "127.0.0.1", listens));
    const page = await (await browser.newContext()).newPage();
    const answers = [];
    page.on("response", (response) => response.url().startsWith(address) && answers.push(response.status()));
    await page.goto(`http://127.0.0.1:${stranger.address().port}/`);
    const got = await page.evaluate(async (embody) => {
      const picture = new Image();
      await new Promise((done) => {
        picture.onload = picture.onerror = done;
        picture.src = `${embody}scene.json`;
      });
      const frame = document.createElement("iframe");
      await new Promise((done) => {
        frame.onload = done;
        frame.src = embody;
        document.body.append(frame);
      });
      const socket = new WebSocket(`${embody.replace("http", "ws")}ws`);
      const opened = await new Promise((done) => {
        socket.onopen = () => done(true);
        socket.onerror = () => done(false);
      });
      return { width: picture.naturalWidth, opened, fetched: await fetch(`${embody}scene.json`, { mode: "no-cors" }).then(() => true, () => false) };
    }, address);
    assert.deepEqual(got, { width: 0, opened: false, fetched: false });
    assert.ok(answers.every((status) => status === 403), `answered ${answers}`);
    // But a link of another site may lead there.
    await page.evaluate((embody) => (location.href = embody), address);
    await page.waitForFunction(() => window.embody?.connected(), null, { timeout: 60000 });
    await page.context().close();
    await new Promise((closed) => stranger.close(closed));
  });
});
