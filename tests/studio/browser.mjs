// SPDX-License-Identifier: MIT
// A real, headless Chromium that shows the Studio.
import { existsSync } from "node:fs";
import { createRequire } from "node:module";
import { fileURLToPath } from "node:url";

// The packages are installed with the front-end, not with its tests.
const { chromium } = createRequire(fileURLToPath(new URL("../../studio/package.json", import.meta.url)))("playwright-core");

const PROGRAMS = [process.env.EMBODY_CHROMIUM, "/usr/bin/chromium", "/usr/bin/chromium-browser", "/usr/bin/google-chrome"];
// Mesa's software WebGL through ANGLE is about four times as fast as Chromium's own SwiftShader.
const FLAGS = [
  "--no-sandbox",
  "--disable-gpu-sandbox",
  "--disable-quic",
  "--no-first-run",
  "--disable-background-networking",
  "--disable-component-update",
  "--disable-sync",
  "--use-gl=angle",
  "--use-angle=gl-egl",
  "--ignore-gpu-blocklist",
];

export async function openBrowser(more = []) {
  const executablePath = PROGRAMS.find((program) => program && existsSync(program));
  if (!executablePath) throw new Error("no Chromium found: install the package chromium or set EMBODY_CHROMIUM");
  return chromium.launch({ executablePath, args: [...FLAGS, ...more], headless: true, timeout: 120000 });
}

/** A connected page of the Studio, with its models drawn. Errors of the page fail the test through `faults`. */
export async function openStudio(browser, address, { width = 1280, height = 800, quality = "low", prepare = async () => {}, recoveries = false, ...more } = {}) {
  const context = await browser.newContext({ viewport: { width, height }, colorScheme: "dark", ...more });
  const page = await context.newPage();
  await prepare(page);
  page.faults = [];
  page.on("pageerror", (error) => page.faults.push(error.message));
  page.on("console", (message) => message.type() === "error" && page.faults.push(message.text()));
  const url = new URL(address);
  url.searchParams.set("quality", quality);
  if (!url.searchParams.has("tour")) url.searchParams.set("tour", "no");
  await page.goto(url.href, { timeout: 120000 });
  await page.waitForFunction(() => window.embody?.connected() && window.embody.loading() === 0, null, { timeout: 120000 });
  // Earlier tests leave unsaved work behind, which the page offers.
  if (!recoveries && (await page.getByTestId("recovery-later").isVisible())) await page.getByTestId("recovery-later").click();
  return page;
}

/** Waits until the pictures that the page has asked for are drawn. */
export function pictured(page) {
  return page.evaluate(() => new Promise((drawn) => requestAnimationFrame(() => drawn())));
}

/** Waits until the page draws nothing new: all has come, nothing moves, and the last picture was drawn finely. */
export async function atRest(page) {
  const rests = await page.evaluate(async () => {
    const wait = (ms) => new Promise((done) => setTimeout(done, ms));
    for (const end = performance.now() + 60000; performance.now() < end; ) {
      const drawn = window.embody.frames();
      // A still picture is drawn finely after 400 ms.
      await wait(600);
      await new Promise((drawn) => requestAnimationFrame(() => drawn()));
      if (window.embody.frames() === drawn && window.embody.loading() === 0) return true;
    }
    return false;
  });
  if (!rests) throw new Error("the page goes on drawing");
}

/** Takes a screenshot; drawing is stopped meanwhile, because a page that always draws may never be still. */
export async function takePicture(page, path) {
  await page.waitForTimeout(300);
  await page.evaluate(() => window.embody.halt());
  await page.screenshot({ path });
  await page.evaluate(() => window.embody.resume());
}

/** A picture of the drawn scene, without the panels and the other people. */
export async function pictureOfScene(page) {
  // Without the ring around the focused element.
  await page.evaluate(() => document.activeElement?.blur());
  await page.evaluate(() => window.embody.showPeople(false));
  await page.evaluate(() => window.embody.caughtUp());
  await atRest(page);
  await page.evaluate(() => window.embody.halt());
  // And without messages that lie over it. The page's policy allows no style element, but a sheet that a script makes.
  await page.evaluate(() => {
    const sheet = new CSSStyleSheet();
    sheet.replaceSync(".toasts, #scene > :not(canvas) { visibility: hidden !important; }");
    document.adoptedStyleSheets = [sheet];
  });
  const picture = await page.getByTestId("canvas").screenshot();
  await page.evaluate(() => (document.adoptedStyleSheets = []));
  await page.evaluate(() => window.embody.showPeople(true));
  await page.evaluate(() => window.embody.resume());
  return picture;
}

/** The fraction of pixels of two pictures of the same size that differ by more than a person may overlook. */
export function difference(page, one, other) {
  return page.evaluate(
    async (pictures) => {
      const [a, b] = await Promise.all(
        pictures.map(async (base64) => {
          const bytes = Uint8Array.from(atob(base64), (character) => character.charCodeAt(0));
          const bitmap = await createImageBitmap(new Blob([bytes], { type: "image/png" }));
          const canvas = new OffscreenCanvas(bitmap.width, bitmap.height);
          const context = canvas.getContext("2d");
          context.drawImage(bitmap, 0, 0);
          return context.getImageData(0, 0, bitmap.width, bitmap.height).data;
        }),
      );
      let different = 0;
      for (let at = 0; at < a.length; at += 4) if ([0, 1, 2].some((channel) => Math.abs(a[at + channel] - b[at + channel]) > 24)) ++different;
      return different / (a.length / 4);
    },
    [one.toString("base64"), other.toString("base64")],
  );
}

/** The mean brightness of a picture, 0 … 255. */
export function brightness(page, picture) {
  return page.evaluate(async (base64) => {
    const bytes = Uint8Array.from(atob(base64), (character) => character.charCodeAt(0));
    const bitmap = await createImageBitmap(new Blob([bytes], { type: "image/png" }));
    const canvas = new OffscreenCanvas(bitmap.width, bitmap.height);
    const context = canvas.getContext("2d");
    context.drawImage(bitmap, 0, 0);
    const { data } = context.getImageData(0, 0, bitmap.width, bitmap.height);
    let sum = 0;
    for (let at = 0; at < data.length; at += 4) sum += data[at] + data[at + 1] + data[at + 2];
    return sum / (0.75 * data.length);
  }, picture.toString("base64"));
}
