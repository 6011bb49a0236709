// SPDX-License-Identifier: MIT
import type { ModelSummary, NewEntity } from "../connection/messages";
import { Signal } from "../signal";
import type { Parts } from "../parts";
import { addUnder, Ghost } from "../tools/ghost";
import { element } from "./element";

/** A press that moves less than this is a click, px. */
const DRAG_REACH = 5;

export interface Carried {
  entity: NewEntity;
  model: ModelSummary | null;
}

/** Drags something from a panel into the scene: a picture at the pointer, and over the scene a ghost on the surface below. */
export class DragIn {
  readonly added = new Signal<ModelSummary>();
  /** Something is being carried. */
  readonly began = new Signal<void>();
  private readonly ghost: Ghost;
  private readonly picture = element("div", { class: "carried", hidden: true });

  constructor(private readonly parts: Pick<Parts, "server" | "notices" | "selection" | "models" | "view">) {
    this.ghost = new Ghost(parts);
    document.body.append(this.picture);
  }

  /** Makes `source` draggable; `carry` returns what is dragged. */
  from(source: HTMLElement, carry: () => Carried): void {
    source.addEventListener("pointerdown", (down) => {
      if (down.button !== 0 || (down.target as HTMLElement).closest(".favourite")) return;
      const ended = new AbortController();
      let carried: Carried | null = null;
      const move = (event: PointerEvent): void => {
        const far = Math.hypot(event.clientX - down.clientX, event.clientY - down.clientY) > DRAG_REACH;
        if (!carried && far) carried = this.begin(source, carry());
        if (carried) this.follow(event);
      };
      const end = (event: PointerEvent | null): void => {
        ended.abort();
        if (carried) this.end(carried, event);
      };
      addEventListener("pointermove", move, { signal: ended.signal });
      addEventListener("pointerup", (event) => end(event), { signal: ended.signal });
      addEventListener("pointercancel", () => end(null), { signal: ended.signal });
      const cancel = (event: KeyboardEvent): void => {
        if (event.key === "Escape") end(null);
      };
      addEventListener("keydown", cancel, { signal: ended.signal });
    });
  }

  private begin(source: HTMLElement, carried: Carried): Carried {
    this.picture.replaceChildren(...[...source.querySelectorAll("img, svg:not(.icon)")].map((each) => each.cloneNode(true)));
    this.picture.hidden = false;
    document.body.classList.add("carrying");
    this.began.emit();
    this.ghost.begin(carried.entity).catch((error: Error) => this.parts.notices.report(error));
    return carried;
  }

  private follow(event: PointerEvent): void {
    this.picture.style.transform = `translate(${event.clientX}px, ${event.clientY}px)`;
    const over = this.isOverScene(event);
    this.picture.classList.toggle("over-scene", over);
    if (over) this.ghost.moveTo(event.clientX, event.clientY);
    else this.ghost.hide();
  }

  private end(carried: Carried, event: PointerEvent | null): void {
    this.picture.hidden = true;
    document.body.classList.remove("carrying");
    this.ghost.end();
    if (!event || !this.isOverScene(event)) return;
    if (carried.model) this.added.emit(carried.model);
    void addUnder(this.parts, carried.entity, event.clientX, event.clientY);
    this.parts.view.canvas.focus();
  }

  private isOverScene(event: PointerEvent): boolean {
    return document.elementFromPoint(event.clientX, event.clientY)?.closest("#scene") !== null;
  }
}
