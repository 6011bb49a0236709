// SPDX-License-Identifier: MIT
import { nameOf } from "../document/scene_document";
import type { Entity } from "../connection/scene_types";
import type { Parts } from "../parts";
import { icon } from "../tools/icons";
import { setLocked } from "../tools/locks";
import { element } from "./element";

/** The list shows no more rows than this; the filter finds the rest. */
const MOST_ROWS = 400;
const DELAY_MS = 80;

/** A list of all entities by name, to find and select those that are small, hidden or far away. */
export class Hierarchy {
  readonly root: HTMLElement;
  private readonly list = element("ul", { role: "listbox", "aria-label": "Entities", "aria-multiselectable": "true", "data-testid": "hierarchy" });
  private readonly filter = element("input", { type: "search", placeholder: "Find in the scene", "aria-label": "Find in the scene", oninput: () => this.fill() });
  private timer = 0;

  constructor(private readonly parts: Pick<Parts, "server" | "document" | "selection" | "entities" | "view">) {
    this.root = element("div", { class: "hierarchy" }, element("div", { class: "browser-search" }, this.filter), this.list);
    parts.document.changed.on(() => {
      clearTimeout(this.timer);
      this.timer = window.setTimeout(() => this.fill(), DELAY_MS);
    });
    parts.selection.changed.on(() => this.mark());
  }

  private fill(): void {
    const words = this.filter.value.trim().toLowerCase();
    const { entities, spawned } = this.parts.document;
    const all = [...entities.values(), ...spawned.values()].filter((entity) => nameOf(entity).toLowerCase().includes(words));
    const rows = all.slice(0, MOST_ROWS).map((entity) => this.row(entity));
    if (all.length > MOST_ROWS) rows.push(element("li", { class: "note" }, `… and ${all.length - MOST_ROWS} more: type a part of a name`));
    if (all.length === 0) rows.push(element("li", { class: "note" }, words ? "Nothing in the scene has that name" : "The scene is empty"));
    const focused = this.focused();
    this.list.replaceChildren(...rows);
    if (focused) this.list.querySelector<HTMLElement>(focused)?.focus();
    this.mark();
  }

  /** A selector of the row or padlock that has the keyboard's focus, which new rows would lose; else null. */
  private focused(): string | null {
    const { activeElement } = document;
    const row = this.list.contains(activeElement) ? activeElement!.closest<HTMLElement>("[data-index]") : null;
    if (!row) return null;
    return `[data-index="${row.dataset["index"]}"]${activeElement === row ? "" : " .padlock"}`;
  }

  private row(entity: Entity): HTMLElement {
    const { parts } = this;
    const isWaiting = parts.document.waiting.has(entity.index);
    const kind = isWaiting ? "waits for its model" : (entity.shape?.type ?? "model");
    const choose = (event: MouseEvent | KeyboardEvent): void => {
      if (event.ctrlKey || event.shiftKey || event.metaKey) parts.selection.toggle(entity.index);
      else parts.selection.set([entity.index]);
    };
    return element(
      "li",
      {
        role: "option",
        tabindex: 0,
        class: entity.enabled === false || isWaiting ? "row disabled" : "row",
        "data-index": entity.index,
        onclick: choose,
        ondblclick: () => parts.view.rig.focus(parts.entities.boundsOf([entity.index], performance.now()), performance.now()),
        onkeydown: (event: KeyboardEvent) => this.key(event, choose),
      },
      element("span", {}, nameOf(entity)),
      element("span", { class: "row-kind" }, parts.document.spawned.has(entity.index) ? `${kind}, spawned` : kind),
      parts.document.spawned.has(entity.index) ? null : this.padlock(entity),
    );
  }

  /** Shown on locked entities, and under the pointer on the others. */
  private padlock({ index, locked = false, ...entity }: Entity): HTMLElement {
    const name = nameOf({ index, ...entity });
    return element(
      "button",
      {
        class: "plain padlock",
        title: locked ? "Locked: it keeps its place, size and existence. Click to unlock (L)" : "Lock it where it is (L)",
        "aria-label": locked ? `Unlock ${name}` : `Lock ${name}`,
        "aria-pressed": String(locked),
        "data-testid": `lock-${index}`,
        onclick: (event: MouseEvent) => (event.stopPropagation(), setLocked(this.parts, [index], !locked)),
        onkeydown: (event: KeyboardEvent) => event.key === "Enter" && event.stopPropagation(),
      },
      icon(locked ? "lock" : "unlock"),
    );
  }

  private key(event: KeyboardEvent, choose: (event: KeyboardEvent) => void): void {
    const row = event.currentTarget as HTMLElement;
    if (event.key === "Enter") choose(event);
    else if (event.key === "ArrowDown") (row.nextElementSibling as HTMLElement | null)?.focus();
    else if (event.key === "ArrowUp") (row.previousElementSibling as HTMLElement | null)?.focus();
    else return;
    event.preventDefault();
  }

  private mark(): void {
    for (const row of this.list.querySelectorAll<HTMLElement>("[data-index]"))
      row.setAttribute("aria-selected", String(this.parts.selection.has(Number(row.dataset["index"]))));
  }
}
