// SPDX-License-Identifier: MIT
import type { Parts } from "../parts";
import type { UserAction } from "../tools/actions";
import { keyName, keysOf } from "../tools/keys";
import { openDialog } from "./dialogs";
import { CONTROLS, HAND_CONTROLS } from "../vr/controls";
import { element } from "./element";
import { t } from "../language";

const MOUSE: readonly (readonly [string, string])[] = [
  [t("Left drag on a thing"), t("move it over floors, onto tables and along walls; with Shift without snapping")],
  [t("Left drag on empty space, or on a locked thing"), t("turn the view")],
  [t("Middle drag, or Shift + left drag"), t("move the view")],
  [t("Wheel"), t("go nearer or farther")],
  [t("Right drag, with W A S D Q E"), t("look around and fly")],
  [t("Click"), t("select; Shift or Ctrl adds")],
  [t("Right click"), t("what can be done with what is under the pointer")],
  [t("Alt + wheel"), t("turn the selection by 15°")],
  [t("Alt + click"), t("one thing of a group alone")],
  [t("Ctrl + drag"), t("select what is in the rectangle")],
  [t("Left drag on a body while playing"), t("pull it with a spring")],
  [t("Left drag on a body with the move tool"), t("slide it sideways at its height")],
];

const PEOPLE: readonly (readonly [string, string])[] = [
  [t("Initials at the top"), t("a click looks where that person looks; on your own it changes your name")],
  [t("Undo and redo"), t("take back what you did, not what others did")],
  [t("New and open"), t("ask the others first: the scene is everybody's")],
  [t("Unsaved work"), t("is kept by itself, and found again under Open a scene")],
];

const STATES: readonly (readonly [string, string, string])[] = [
  ["active", t("active"), t("moves, or something pulls at it")],
  ["wants", t("wants to sleep"), t("is quiet, and sleeps soon")],
  ["asleep", t("asleep"), t("rests and costs nothing until it is touched")],
];

const MATTER: readonly (readonly [string, string])[] = [
  [t("Add one"), t("cloth, rope, water, sand and a cushion are among the primitives on the left")],
  [t("Physical kind"), t("in the panel on the right makes any thing what its list offers, such as soft, cloth or fluid, also while it plays")],
  [t("Category"), t("of a primitive, such as honey, curtain, gravel: it takes kind and numbers of that")],
  [t("Pins"), t("hold edges, corners, ends or a place you click on; by the world or by another thing")],
  [t("Wind"), t("and gusts are under Air, with nothing selected")],
  [t("Settle"), t("keeps where things lie, and their folds, dents, heaps and puddles")],
];

/** Mouse, keys and colours; a key can be changed by clicking on it. */
export function openHelp(parts: Pick<Parts, "preferences">, actions: readonly UserAction[]): void {
  const groups = new Map<string, UserAction[]>();
  for (const action of actions) {
    if (keysOf(parts, action).length === 0) continue;
    groups.set(action.group, [...(groups.get(action.group) ?? []), action]);
  }
  const line = (keys: Node, what: string) => element("div", { class: "key-line" }, keys, element("span", {}, what));
  const section = (title: string, lines: HTMLElement[]) => element("section", {}, element("h3", {}, title), ...lines);
  const dialog = openDialog(
    t("Help and keys"),
    "help",
    element(
      "div",
      { class: "help-columns" },
      section(t("Mouse"), MOUSE.map(([gesture, what]) => line(element("span", { class: "gesture" }, gesture), what))),
      section(t("With others"), PEOPLE.map(([name, what]) => line(element("span", { class: "gesture" }, name), what))),
      section(t("Soft things, cloth, ropes, liquids, grains"), MATTER.map(([name, what]) => line(element("span", { class: "gesture" }, name), what))),
      section(t("In a headset"), [...CONTROLS, ...HAND_CONTROLS].map(([gesture, what]) => line(element("span", { class: "gesture" }, gesture), what))),
      section(t("Tint of things while there is a simulation"), [
        ...STATES.map(([state, name, what]) => line(element("span", {}, element("i", { class: `swatch ${state}` }), name), what)),
        element("p", { class: "note" }, t("The view options colour things all over; T turns it off.")),
      ]),
      ...[...groups].map(([title, group]) => section(title, group.map((action) => line(keyButton(parts, action), action.label)))),
    ),
    element(
      "div",
      { class: "dialog-buttons" },
      element("span", { class: "note" }, t("Click on a key to change it.")),
      element("button", { onclick: () => (parts.preferences.set("keys", {}), dialog.close()) }, t("Restore all keys")),
    ),
  );
}

function keyButton(parts: Pick<Parts, "preferences">, action: UserAction): HTMLElement {
  const button = element("button", { class: "key", "aria-label": t("Key of “{{label}}”", { label: action.label }) }, keysOf(parts, action).join(t(" or ")));
  button.addEventListener("click", () => {
    button.textContent = t("press a key");
    button.addEventListener(
      "keydown",
      (event) => {
        event.preventDefault();
        event.stopPropagation();
        if (["Shift", "Control", "Alt", "Meta"].includes(event.key)) return;
        if (event.key !== "Escape") parts.preferences.set("keys", { ...parts.preferences.get("keys"), [action.id]: keyName(event) });
        button.textContent = keysOf(parts, action).join(t(" or "));
        button.blur();
      },
      { signal: untilBlur(button) },
    );
  });
  return button;
}

function untilBlur(button: HTMLElement): AbortSignal {
  const ended = new AbortController();
  button.addEventListener("blur", () => ended.abort(), { once: true });
  return ended.signal;
}
