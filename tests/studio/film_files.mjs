// SPDX-License-Identifier: MIT
// Films as files: played in Chromium to look at their pictures, and joined packet by packet.
import { readFileSync, writeFileSync } from "node:fs";
import { createRequire } from "node:module";
import { join } from "node:path";
import { fileURLToPath } from "node:url";

// The packages are installed with the front-end, not with its tests.
const mediabunny = createRequire(fileURLToPath(new URL("../../studio/package.json", import.meta.url)))("mediabunny");

const PLACE = "http://film.invalid";

/**
 * Plays a WebM file: its length and size, and of the pictures at `times` (s) the mean light, the number of red pixels, their mean row, and a coarse
 * gray copy of 32 × 18. Pictures are also written to `folder`, where one is given. A picture of the film lasts so long at most, s.
 */
export async function playFilm(browser, path, times, folder = null, longest = 0.1) {
  const page = await browser.newPage();
  await page.route(`${PLACE}/**`, (route) => (route.request().url().endsWith(".webm") ? route.fulfill({ path, contentType: "video/webm" }) : route.fulfill({ body: "<!doctype html>", contentType: "text/html" })));
  await page.goto(`${PLACE}/`);
  const film = await page.evaluate(
    async ([address, times, withFiles, longest]) => {
      const video = document.createElement("video");
      video.muted = true;
      video.src = URL.createObjectURL(await (await fetch(address)).blob());
      await new Promise((done, failed) => ((video.onloadedmetadata = done), (video.onerror = () => failed(new Error(video.error.message)))));
      const canvas = new OffscreenCanvas(video.videoWidth, video.videoHeight);
      const pen = canvas.getContext("2d", { willReadFrequently: true });
      const small = new OffscreenCanvas(32, 18).getContext("2d", { willReadFrequently: true });
      // As text: a list of numbers takes a hundred times its bytes on its way out of the page.
      const fileOf = async () => {
        const reader = new FileReader();
        reader.readAsDataURL(await canvas.convertToBlob({ type: "image/png" }));
        await new Promise((done) => (reader.onload = done));
        return reader.result.split(",")[1];
      };
      const pictures = [];
      for (const time of times) {
        // The picture may come after the seek has ended, and after one that was still on its way.
        const wanted = Math.min(time, video.duration - 0.01);
        const shown = new Promise((done) => {
          const look = (_, { mediaTime }) => (mediaTime < wanted + 0.02 && mediaTime > wanted - longest ? done() : video.requestVideoFrameCallback(look));
          video.requestVideoFrameCallback(look);
        });
        video.currentTime = wanted;
        await new Promise((done) => (video.onseeked = done));
        // None comes where the same picture is shown as before.
        await Promise.race([shown, new Promise((done) => setTimeout(done, 5000))]);
        pen.drawImage(video, 0, 0);
        const { data } = pen.getImageData(0, 0, canvas.width, canvas.height);
        let light = 0, red = 0, row = 0;
        for (let at = 0; at < data.length; at += 4) {
          light += data[at] + data[at + 1] + data[at + 2];
          if (data[at] > 110 && data[at] > 2 * data[at + 2]) ++red, (row += Math.floor(at / 4 / canvas.width));
        }
        small.drawImage(canvas, 0, 0, 32, 18);
        const coarse = small.getImageData(0, 0, 32, 18).data;
        const gray = Array.from({ length: 32 * 18 }, (_, at) => Math.round((coarse[4 * at] + coarse[4 * at + 1] + coarse[4 * at + 2]) / 3));
        const file = withFiles ? await fileOf() : null;
        pictures.push({ time, light: light / (data.length / 4) / 3, red, row: row / Math.max(red, 1), gray, file });
      }
      return { duration: video.duration, width: video.videoWidth, height: video.videoHeight, pictures };
    },
    [`${PLACE}/film.webm`, times, folder !== null, longest],
  );
  await page.close();
  for (const { time, file } of film.pictures) if (file) writeFileSync(join(folder, `film-${time.toFixed(1).padStart(5, "0")}.png`), Buffer.from(file, "base64"));
  return film;
}

/** The mean difference of two pictures of playFilm, 0 … 255. */
export function pictureDifference(one, other) {
  return one.gray.reduce((sum, value, at) => sum + Math.abs(value - other.gray[at]), 0) / one.gray.length;
}

/**
 * Joins WebM films of one size and codec into one, packet by packet: nothing is decoded or encoded. A part is {path, speed}: with a speed of 4 it
 * takes a quarter of its time. Returns the length, s.
 */
export async function joinFilms(parts, path) {
  const { ALL_FORMATS, BufferSource, BufferTarget, EncodedPacket, EncodedPacketSink, EncodedVideoPacketSource, Input, Output, WebMOutputFormat } = mediabunny;
  const output = new Output({ format: new WebMOutputFormat(), target: new BufferTarget() });
  let source = null;
  let start = 0;
  for (const { path: file, speed = 1 } of parts) {
    const track = await new Input({ source: new BufferSource(readFileSync(file)), formats: ALL_FORMATS }).getPrimaryVideoTrack();
    if (!source) {
      source = new EncodedVideoPacketSource(track.codec);
      output.addVideoTrack(source);
      await output.start();
    }
    const decoderConfig = await track.getDecoderConfig();
    let end = start;
    for await (const packet of new EncodedPacketSink(track).packets()) {
      const [time, duration] = [start + packet.timestamp / speed, packet.duration / speed];
      await source.add(new EncodedPacket(packet.data, packet.type, time, duration), { decoderConfig });
      end = Math.max(end, time + duration);
    }
    start = end;
  }
  await output.finalize();
  writeFileSync(path, Buffer.from(output.target.buffer));
  return start;
}
