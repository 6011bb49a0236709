// SPDX-License-Identifier: MIT
// Tells the others where this page looks and points, and what it has selected.
import type { Presence } from "../connection/messages";
import type { Vector } from "../connection/scene_types";
import type { Parts } from "../parts";

/** At most 15 messages a second: the pictures of the others blend between them. */
const EVERY_MS = 1000 / 15;
/** Places are told in millimetres: what moves less has not changed. */
const PER_METRE = 1000;

export class PresenceSender {
  private sent = new Map<string, string>();
  private timer = 0;
  private lastSent = 0;
  private lastPoint = 0;

  constructor(private readonly parts: Pick<Parts, "server" | "selection" | "people" | "view">) {
    const { people, selection, view } = parts;
    people.put({ mode: "page" });
    people.ownMoved.on(() => this.sendSoon());
    selection.changed.on(() => people.put({ selection: [...selection.indices] }));
    view.rig.changed.on(() => people.put({ camera: view.rig.seen() }));
    view.canvas.addEventListener("pointermove", (event) => this.point(event));
    view.canvas.addEventListener("pointerleave", () => people.put({ pointer: null }));
    // Who is new knows nothing yet.
    people.changed.on(() => {
      this.sent.clear();
      this.sendSoon();
    });
  }

  private point(event: PointerEvent): void {
    const { people, view } = this.parts;
    // To find what is under the pointer has its price: not where nobody sees it, nor while the camera turns.
    if (people.others.length === 0 || event.buttons !== 0 || performance.now() - this.lastPoint < EVERY_MS) return;
    this.lastPoint = performance.now();
    const point = view.pick(event.clientX, event.clientY)?.point ?? null;
    people.put({ pointer: point && { position: point.toArray().map((length) => Math.round(length * PER_METRE) / PER_METRE) as Vector } });
  }

  private sendSoon(): void {
    if (this.timer || this.parts.people.others.length === 0) return;
    this.timer = window.setTimeout(() => this.send(), Math.max(0, this.lastSent + EVERY_MS - performance.now()));
  }

  /** Sends what has changed since it was sent last. */
  private send(): void {
    this.timer = 0;
    const { people, server } = this.parts;
    if (people.others.length === 0 || !server.isOpen) return;
    const news: Record<string, unknown> = {};
    for (const [name, value] of Object.entries(people.own)) {
      const text = JSON.stringify(value);
      if (this.sent.get(name) === text) continue;
      this.sent.set(name, text);
      news[name] = value;
    }
    if (Object.keys(news).length === 0) return;
    this.lastSent = performance.now();
    // What gets lost is sent again with the next change; nobody needs a message about it.
    server.request("client.present", news as Presence).catch(() => this.sent.clear());
  }
}
