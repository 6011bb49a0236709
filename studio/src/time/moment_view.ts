// SPDX-License-Identifier: MIT
import { decodeFrame, type Frame } from "../connection/frame";
import type { Parts } from "../parts";

type Needed = Pick<Parts, "server" | "document" | "motion" | "entities" | "view">;

/** Thrown where the server cannot be asked. */
export class NoMoment extends Error {}

/** Draws moments of the take on this page alone; the next picture shows them. */
export class MomentView {
  constructor(private readonly parts: Needed) {}

  /** The state of everything at a time of the take, s; without a time as everybody sees it now. */
  async ask(time?: number): Promise<Frame> {
    const told = await this.parts.server.request("time.frame", time === undefined ? {} : { time });
    for (const entity of told.spawned) if (!this.parts.document.entity(entity.index)) this.parts.document.spawn(entity);
    return decodeFrame(bytesOf(told.frame));
  }

  /** Shows it at once, with all that belongs to it: models, forms and surfaces. */
  async show(frame: Frame): Promise<void> {
    const { document, motion, entities, view } = this.parts;
    const there = new Set(frame.indices);
    for (const index of [...document.absent]) if (there.has(index)) document.spawn(document.entities.get(index)!);
    for (const index of [...document.entities.keys(), ...document.spawned.keys()])
      if (!there.has(index) && !document.absent.has(index) && !document.waiting.has(index)) document.despawn(index);
    const now = performance.now();
    motion.take(frame, now, false);
    entities.takePoints(frame, now, false);
    while (entities.isSettling) await new Promise<void>((done) => setTimeout(done, 5));
    view.advance(now);
    await entities.clouds.settle(now);
    view.advance(now);
  }
}

function bytesOf(base64: string): ArrayBuffer {
  const text = atob(base64);
  const bytes = new Uint8Array(text.length);
  for (let at = 0; at < text.length; ++at) bytes[at] = text.charCodeAt(at);
  return bytes.buffer;
}
