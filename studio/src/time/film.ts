// SPDX-License-Identifier: MIT
import { BufferTarget, CanvasSource, getFirstEncodableVideoCodec, Output, WebMOutputFormat } from "mediabunny";
import type { Parts } from "../parts";
import { Capture } from "../view/capture";
import { type FilmPlan, picturesOf } from "./film_plan";
import { MomentView } from "./moment_view";
import { t } from "../language";

/** Bits for each pixel of a picture: sharp edges and flat colours as here stay clean. */
const BITS_PER_PIXEL = 0.12;
const LEAST_BITRATE = 1e6;

/** Why this browser makes no films; null where it does. */
export async function filmHindrance(width: number, height: number): Promise<string | null> {
  if (typeof VideoEncoder === "undefined") return t("This browser cannot encode video (it has no WebCodecs, or the page is not secure). Chromium, Edge and newer Firefox and Safari can, over https or on localhost.");
  if (!(await getFirstEncodableVideoCodec(["vp9", "vp8"], { width, height }))) return t("This browser encodes neither VP9 nor VP8 in this size. Choose a smaller one.");
  return null;
}

/**
 * Makes a WebM film, picture by picture at exact simulated times, however long one takes. Null where `signal` ended it. The page
 * shows the pictures meanwhile, and what everybody sees afterwards.
 */
export async function makeFilm(
  parts: Pick<Parts, "server" | "document" | "motion" | "entities" | "view">,
  plan: FilmPlan,
  tell: (done: number, of: number) => void,
  signal: AbortSignal,
): Promise<Blob | null> {
  const codec = await getFirstEncodableVideoCodec(["vp9", "vp8"], { width: plan.width, height: plan.height });
  if (!codec) throw new Error(t("This browser encodes neither VP9 nor VP8 in this size."));
  const canvas = new OffscreenCanvas(plan.width, plan.height);
  canvas.getContext("2d");
  const bitrate = Math.max(LEAST_BITRATE, Math.round(BITS_PER_PIXEL * plan.width * plan.height * plan.fps));
  const source = new CanvasSource(canvas, { codec, bitrate, keyFrameInterval: 2 });
  const output = new Output({ format: new WebMOutputFormat(), target: new BufferTarget() });
  output.addVideoTrack(source, { frameRate: plan.fps });
  await output.start();
  const moments = new MomentView(parts);
  const { rig } = parts.view;
  const { position, target } = rig.seen();
  const capture = new Capture(parts.view, plan.width, plan.height);
  try {
    const count = picturesOf(plan);
    for (let picture = 0; picture < count; ++picture) {
      if (signal.aborted) {
        await output.cancel();
        return null;
      }
      await moments.show(await moments.ask(plan.from + (picture / plan.fps) * plan.rate));
      if (plan.turns !== 0) rig.place(turned(position, target, (2 * Math.PI * plan.turns * picture) / count), target);
      capture.drawOn(canvas);
      await source.add(picture / plan.fps, 1 / plan.fps);
      tell(picture + 1, count);
    }
    await output.finalize();
    return new Blob([output.target.buffer!], { type: "video/webm" });
  } finally {
    if (plan.turns !== 0) rig.place(position, target);
    capture.end();
    // Frames of the server were left alone meanwhile.
    await moments.show(await moments.ask());
    parts.view.invalidate();
  }
}

/** A place turned about the vertical through another. */
function turned([x, y, z]: readonly number[], [cx, , cz]: readonly number[], angle: number): [number, number, number] {
  const [cos, sin] = [Math.cos(angle), Math.sin(angle)];
  return [cx! + cos * (x! - cx!) + sin * (z! - cz!), y!, cz! - sin * (x! - cx!) + cos * (z! - cz!)];
}
