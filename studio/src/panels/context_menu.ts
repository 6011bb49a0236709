// SPDX-License-Identifier: MIT
import type { Parts } from "../parts";
import type { UserAction } from "../tools/actions";
import { keysOf } from "../tools/keys";
import { element } from "./element";

/** What the menu offers, by ids of actions; a line between the lists. */
const ON_THINGS = [
  ["edit.cut", "edit.copy", "edit.paste", "edit.duplicate"],
  ["edit.drop", "arrange.turn.left", "arrange.turn.right", "arrange.mirror.x"],
  ["arrange.group", "arrange.ungroup"],
  ["view.focus", "edit.delete"],
];
const ON_NOTHING = [["edit.paste"], ["edit.select_all", "edit.undo", "edit.redo"], ["view.search", "view.palette"]];

/** The menu of the right button: commands for the selection, or for the scene where nothing is selected. */
export function openContextMenu(parts: Pick<Parts, "preferences" | "selection" | "view">, actions: readonly UserAction[], at: { x: number; y: number }): void {
  const lists = parts.selection.indices.length > 0 ? ON_THINGS : ON_NOTHING;
  const known = lists.map((ids) => ids.flatMap((id) => actions.find((action) => action.id === id) ?? []));
  openMenu(
    known.map((list) => list.map((action) => ({ label: action.label, key: keysOf(parts, action)[0] ?? "", possible: action.possible?.() ?? true, run: action.run, id: action.id }))),
    at,
    () => parts.view.canvas.focus(),
  );
}

export interface MenuItem {
  label: string;
  key?: string;
  possible?: boolean;
  id?: string;
  run: () => void;
}

/** A menu at a place of the page; arrow keys, Enter and Escape work in it. */
export function openMenu(lists: readonly (readonly MenuItem[])[], at: { x: number; y: number }, closed: () => void = () => undefined): void {
  document.querySelector(".context-menu")?.remove();
  const ended = new AbortController();
  const menu = element("div", { class: "context-menu", role: "menu", "data-testid": "context-menu", tabindex: -1 });
  const close = (): void => {
    ended.abort();
    menu.remove();
    closed();
  };
  lists.forEach((list, number) => {
    if (number > 0) menu.append(element("hr", {}));
    for (const item of list) {
      const run = (): void => {
        close();
        item.run();
      };
      menu.append(
        element("button", { role: "menuitem", disabled: item.possible === false, "data-testid": item.id && `menu.${item.id}`, onclick: run }, element("span", {}, item.label), element("kbd", {}, item.key ?? "")),
      );
    }
  });
  document.body.append(menu);
  // Within the page.
  const { width, height } = menu.getBoundingClientRect();
  menu.style.left = `${Math.max(0, Math.min(at.x, innerWidth - width - 4))}px`;
  menu.style.top = `${Math.max(0, Math.min(at.y, innerHeight - height - 4))}px`;

  const items = () => [...menu.querySelectorAll<HTMLButtonElement>("button:not(:disabled)")];
  menu.addEventListener("keydown", (event) => {
    const all = items();
    const now = all.indexOf(document.activeElement as HTMLButtonElement);
    if (event.key === "ArrowDown") all[(now + 1) % all.length]?.focus();
    else if (event.key === "ArrowUp") all[(now + all.length - 1) % all.length]?.focus();
    else if (event.key === "Escape" || event.key === "Tab") close();
    else return;
    event.preventDefault();
    event.stopPropagation();
  });
  menu.addEventListener("contextmenu", (event) => event.preventDefault());
  addEventListener("pointerdown", (event) => !menu.contains(event.target as Node) && close(), { capture: true, signal: ended.signal });
  addEventListener("blur", close, { signal: ended.signal });
  addEventListener("resize", close, { signal: ended.signal });
  (items()[0] ?? menu).focus();
}
