// SPDX-License-Identifier: MIT
import type { Parts } from "../parts";
import { Capture } from "../view/capture";
import { drawCaption } from "./caption";
import { type FilmPlan, picturesOf } from "./film_plan";
import { FilmWriter } from "./film_writer";
import { MomentView } from "./moment_view";

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
  const canvas = new OffscreenCanvas(plan.width, plan.height);
  canvas.getContext("2d");
  const writer = await FilmWriter.open(canvas, plan.fps);
  const moments = new MomentView(parts);
  const { rig } = parts.view;
  const { position, target } = rig.seen();
  const capture = new Capture(parts.view, plan.width, plan.height);
  try {
    const count = picturesOf(plan);
    for (let picture = 0; picture < count; ++picture) {
      if (signal.aborted) {
        await writer.cancel();
        return null;
      }
      await moments.show(await moments.ask(plan.from + (picture / plan.fps) * plan.rate));
      if (plan.turns !== 0) rig.place(turned(position, target, (2 * Math.PI * plan.turns * picture) / count), target);
      capture.drawOn(canvas);
      drawCaption(canvas, plan.text);
      await writer.add(picture / plan.fps, 1 / plan.fps);
      tell(picture + 1, count);
    }
    return await writer.finish();
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
