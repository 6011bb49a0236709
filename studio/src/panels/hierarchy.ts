// SPDX-License-Identifier: MIT
import { isInGroup, membersOf } from "../document/groups";
import { nameOf } from "../document/scene_document";
import type { Entity } from "../connection/scene_types";
import type { Parts } from "../parts";
import { icon } from "../tools/icons";
import { setLocked } from "../tools/locks";
import { element, setText, show } from "./element";
import { afterPress } from "./press";
import { t, translateServerText } from "../language";

/** The tree shows no more rows than this; the filter finds the rest. */
const MOST_ROWS = 400;
const DELAY_MS = 80;

/** What a drag from the tree carries: things, or a group as a whole. */
type Carried = { indices: number[]; from?: string };

/** All entities by name in their groups: to find and select those that are small, hidden or far away, and to put them into groups by dragging. */
export class Hierarchy {
  readonly root: HTMLElement;
  private readonly list = element("ul", { role: "tree", "aria-label": t("Entities"), "aria-multiselectable": "true", "data-testid": "hierarchy" });
  private readonly filter = element("input", { type: "search", placeholder: t("Find in the scene"), "aria-label": t("Find in the scene"), oninput: () => this.fill() });
  private readonly folded = new Set<string>();
  private carried: Carried | null = null;
  private rows = 0;
  private timer = 0;
  private readonly refill = (): void => this.fill();

  constructor(private readonly parts: Pick<Parts, "server" | "document" | "selection" | "entities" | "view" | "warnings">) {
    this.root = element("div", { class: "hierarchy" }, element("div", { class: "browser-search" }, this.filter), this.list);
    // Beside the rows: out of all groups.
    this.takesDrops(this.list, "");
    parts.document.changed.on(() => {
      clearTimeout(this.timer);
      this.timer = window.setTimeout(() => afterPress(this.refill), DELAY_MS);
    });
    parts.selection.changed.on(() => this.mark());
    parts.warnings.changed.on(() => this.warn());
  }

  private fill(): void {
    const words = this.filter.value.trim().toLowerCase();
    const { entities, spawned } = this.parts.document;
    const all = [...entities.values(), ...spawned.values()].filter((entity) => `${nameOf(entity)} ${entity.group ?? ""}`.toLowerCase().includes(words));
    this.rows = 0;
    const rows = this.branch(all, "", 1);
    if (this.rows > MOST_ROWS) rows.push(element("li", { class: "note" }, t("… and more: type a part of a name")));
    if (all.length === 0) rows.push(element("li", { class: "note" }, words ? t("Nothing in the scene has that name") : t("The scene is empty")));
    const focused = this.focused();
    this.list.replaceChildren(...rows);
    if (focused) this.list.querySelector<HTMLElement>(focused)?.focus();
    this.mark();
    this.warn();
  }

  /** Marks what has values that make no sense. */
  private warn(): void {
    for (const mark of this.list.querySelectorAll<HTMLElement>(".row-warning")) {
      const index = Number(mark.closest<HTMLElement>("[data-index]")!.dataset["index"]);
      const text = this.parts.warnings.of(index).map(({ label, why }) => `${translateServerText(label)}: ${translateServerText(why)}`).join("\n");
      show(mark, text !== "");
      mark.title = text;
      setText(mark, text && "⚠");
      mark.setAttribute("aria-label", text);
    }
  }

  /** A selector of the row or padlock that has the keyboard's focus, which new rows would lose; else null. */
  private focused(): string | null {
    const { activeElement } = document;
    const row = this.list.contains(activeElement) ? activeElement!.closest<HTMLElement>("[data-index]") : null;
    if (!row) return null;
    return `[data-index="${row.dataset["index"]}"]${activeElement === row ? "" : " .padlock"}`;
  }

  /** The rows of a group, or of all: its groups first. */
  private branch(all: readonly Entity[], group: string, level: number): HTMLElement[] {
    const prefix = group ? `${group}/` : "";
    const inner = new Set<string>();
    const own: Entity[] = [];
    for (const entity of all) {
      const path = entity.group ?? "";
      if (path === group) own.push(entity);
      else if (path.startsWith(prefix)) inner.add(prefix + path.slice(prefix.length).split("/")[0]);
    }
    const rows: HTMLElement[] = [];
    for (const path of inner) {
      if (++this.rows > MOST_ROWS) return rows;
      const members = all.filter((entity) => isInGroup(entity.group, path));
      rows.push(this.groupRow(path, members, level));
    }
    for (const entity of own) {
      if (++this.rows > MOST_ROWS) return rows;
      rows.push(this.row(entity, level));
    }
    return rows;
  }

  private groupRow(path: string, members: readonly Entity[], level: number): HTMLElement {
    const open = !this.folded.has(path);
    const flip = (event: Event): void => {
      event.stopPropagation();
      if (open) this.folded.add(path);
      else this.folded.delete(path);
      this.fill();
    };
    const choose = (event: MouseEvent | KeyboardEvent): void => {
      event.stopPropagation();
      this.choose(membersOf(this.parts.document, path), event);
    };
    const title = element(
      "div",
      {
        class: "row group-row",
        tabindex: 0,
        draggable: "true",
        "data-group": path,
        title: t("Click: select the group. Double click: rename it"),
        onclick: choose,
        ondblclick: () => this.rename(title, path),
        onkeydown: (event: KeyboardEvent) => {
          if (event.key === "ArrowLeft" || event.key === "ArrowRight") flip(event);
          else if (event.key === "F2") this.rename(title, path);
          else this.key(event, choose);
        },
      },
      element("button", { class: "fold", "aria-label": open ? t("Fold") : t("Unfold"), tabindex: -1, onclick: flip }, open ? "▾" : "▸"),
      element("span", {}, path.split("/").at(-1)!),
      element("span", { class: "row-kind" }, String(members.length)),
    );
    title.style.setProperty("--level", String(level));
    this.takesDrops(title, path);
    const parent = path.includes("/") ? path.slice(0, path.lastIndexOf("/")) : "";
    title.addEventListener("dragstart", (event) => this.carry(event, { indices: members.map(({ index }) => index), from: parent }));
    const item = element("li", { role: "treeitem", "aria-expanded": String(open), "aria-level": level, "aria-label": path }, title);
    if (open) item.append(element("ul", { role: "group" }, ...this.branch(members, path, level + 1)));
    return item;
  }

  private row(entity: Entity, level: number): HTMLElement {
    const { parts } = this;
    const isWaiting = parts.document.waiting.has(entity.index);
    const kind = isWaiting ? t("waits for its model") : translateServerText(entity.shape?.type ?? "model");
    const choose = (event: MouseEvent | KeyboardEvent): void => {
      event.stopPropagation();
      this.choose([entity.index], event);
    };
    const row = element(
      "li",
      {
        role: "treeitem",
        tabindex: 0,
        draggable: "true",
        class: entity.enabled === false || isWaiting ? "row disabled" : "row",
        "aria-level": level,
        "data-index": entity.index,
        onclick: choose,
        ondblclick: () => parts.view.rig.focus(parts.entities.boundsOf([entity.index], performance.now()), performance.now()),
        onkeydown: (event: KeyboardEvent) => this.key(event, choose),
      },
      element("span", {}, nameOf(entity)),
      element("span", { class: "row-kind" }, parts.document.spawned.has(entity.index) ? t("{{kind}}, spawned", { kind }) : kind),
      element("span", { class: "row-warning", role: "img" }),
      parts.document.spawned.has(entity.index) ? null : this.padlock(entity),
    );
    row.style.setProperty("--level", String(level));
    row.addEventListener("dragstart", (event) => {
      const chosen = parts.selection.has(entity.index) ? [...parts.selection.indices] : [entity.index];
      this.carry(event, { indices: chosen });
    });
    this.takesDrops(row, entity.group ?? "");
    return row;
  }

  /** Shown on locked entities, and under the pointer on the others. */
  private padlock({ index, locked = false, ...entity }: Entity): HTMLElement {
    const name = nameOf({ index, ...entity });
    return element(
      "button",
      {
        class: "plain padlock",
        title: locked ? t("Locked: it keeps its place, size and existence. Click to unlock (L)") : t("Lock it where it is (L)"),
        "aria-label": locked ? t("Unlock {{name}}", { name }) : t("Lock {{name}}", { name }),
        "aria-pressed": String(locked),
        "data-testid": `lock-${index}`,
        onclick: (event: MouseEvent) => (event.stopPropagation(), setLocked(this.parts, [index], !locked)),
        onkeydown: (event: KeyboardEvent) => event.key === "Enter" && event.stopPropagation(),
      },
      icon(locked ? "lock" : "unlock"),
    );
  }

  private choose(indices: readonly number[], event: MouseEvent | KeyboardEvent): void {
    const { selection } = this.parts;
    if (!(event.ctrlKey || event.shiftKey || event.metaKey)) selection.set(indices);
    else if (indices.every((index) => selection.has(index))) selection.set(selection.indices.filter((index) => !indices.includes(index)));
    else selection.set([...selection.indices, ...indices]);
  }

  private carry(event: DragEvent, carried: Carried): void {
    event.stopPropagation();
    this.carried = carried;
    event.dataTransfer?.setData("text/plain", `${carried.indices.length}`);
    if (event.dataTransfer) event.dataTransfer.effectAllowed = "move";
  }

  /** What is dropped here comes into this group. */
  private takesDrops(target: HTMLElement, group: string): void {
    target.addEventListener("dragover", (event) => {
      if (!this.carried) return;
      event.preventDefault();
      event.stopPropagation();
      target.classList.add("drop-target");
    });
    target.addEventListener("dragleave", () => target.classList.remove("drop-target"));
    target.addEventListener("drop", (event) => {
      event.preventDefault();
      event.stopPropagation();
      target.classList.remove("drop-target");
      const carried = this.carried;
      this.carried = null;
      if (carried) void this.parts.server.command("entity.set_group", { ...carried, group });
    });
  }

  private rename(title: HTMLElement, path: string): void {
    const parent = path.includes("/") ? path.slice(0, path.lastIndexOf("/") + 1) : "";
    const field = element("input", { type: "text", value: path.slice(parent.length), "aria-label": t("Name of the group") });
    let ended = false;
    const end = (keep: boolean): void => {
      if (ended) return;
      ended = true;
      const name = field.value.trim();
      if (keep && name && parent + name !== path)
        void this.parts.server.command("entity.set_group", { indices: membersOf(this.parts.document, path), from: path, group: parent + name.replaceAll("/", " ") });
      this.fill();
    };
    field.addEventListener("keydown", (event) => {
      event.stopPropagation();
      if (event.key === "Enter") end(true);
      else if (event.key === "Escape") end(false);
    });
    field.addEventListener("blur", () => end(true));
    title.replaceChildren(field);
    field.select();
  }

  private key(event: KeyboardEvent, choose: (event: KeyboardEvent) => void): void {
    const rows = [...this.list.querySelectorAll<HTMLElement>(".row")];
    const now = rows.indexOf(event.currentTarget as HTMLElement);
    if (event.key === "Enter") choose(event);
    else if (event.key === "ArrowDown") rows[now + 1]?.focus();
    else if (event.key === "ArrowUp") rows[now - 1]?.focus();
    else return;
    event.preventDefault();
  }

  private mark(): void {
    const { selection, document } = this.parts;
    for (const row of this.list.querySelectorAll<HTMLElement>("[data-index]"))
      row.setAttribute("aria-selected", String(selection.has(Number(row.dataset["index"]))));
    for (const row of this.list.querySelectorAll<HTMLElement>("[data-group]")) {
      const all = membersOf(document, row.dataset["group"]!);
      row.closest("[role=treeitem]")!.setAttribute("aria-selected", String(all.length > 0 && all.every((index) => selection.has(index))));
    }
  }
}
