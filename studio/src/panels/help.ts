// SPDX-License-Identifier: MIT
import type { Parts } from "../parts";
import type { UserAction } from "../tools/actions";
import { keyName, keysOf } from "../tools/keys";
import { openDialog } from "./dialogs";
import { CONTROLS, HAND_CONTROLS } from "../vr/controls";
import { element } from "./element";

const MOUSE: readonly (readonly [string, string])[] = [
  ["Left drag on a thing", "move it over floors, onto tables and along walls; with Shift without snapping"],
  ["Left drag on empty space, or on a locked thing", "turn the view"],
  ["Middle drag, or Shift + left drag", "move the view"],
  ["Wheel", "go nearer or farther"],
  ["Right drag, with W A S D Q E", "look around and fly"],
  ["Click", "select; Shift or Ctrl adds"],
  ["Right click", "what can be done with what is under the pointer"],
  ["Alt + wheel", "turn the selection by 15°"],
  ["Alt + click", "one thing of a group alone"],
  ["Ctrl + drag", "select what is in the rectangle"],
  ["Left drag on a body while playing", "pull it with a spring"],
  ["Left drag on a body with the move tool", "slide it sideways at its height"],
];

const PEOPLE: readonly (readonly [string, string])[] = [
  ["Initials at the top", "a click looks where that person looks; on your own it changes your name"],
  ["Undo and redo", "take back what you did, not what others did"],
  ["New and open", "ask the others first: the scene is everybody's"],
  ["Unsaved work", "is kept by itself, and found again under Open a scene"],
];

const STATES: readonly (readonly [string, string, string])[] = [
  ["active", "active", "moves, or something pulls at it"],
  ["wants", "wants to sleep", "is quiet, and sleeps soon"],
  ["asleep", "asleep", "rests and costs nothing until it is touched"],
];

const MATTER: readonly (readonly [string, string])[] = [
  ["Add one", "cloth, rope, water, sand and a cushion are among the primitives on the left"],
  ["Physical kind", "in the panel on the right makes any thing what its list offers, such as soft, cloth or fluid, also while it plays"],
  ["Category", "of a primitive, such as honey, curtain, gravel: it takes kind and numbers of that"],
  ["Pins", "hold edges, corners, ends or a place you click on; by the world or by another thing"],
  ["Wind", "and gusts are under Air, with nothing selected"],
  ["Keep poses", "keeps where things lie, not dents, folds, heaps or puddles"],
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
    "Help and keys",
    "help",
    element(
      "div",
      { class: "help-columns" },
      section("Mouse", MOUSE.map(([gesture, what]) => line(element("span", { class: "gesture" }, gesture), what))),
      section("With others", PEOPLE.map(([name, what]) => line(element("span", { class: "gesture" }, name), what))),
      section("Soft things, cloth, ropes, liquids, grains", MATTER.map(([name, what]) => line(element("span", { class: "gesture" }, name), what))),
      section("In a headset", [...CONTROLS, ...HAND_CONTROLS].map(([gesture, what]) => line(element("span", { class: "gesture" }, gesture), what))),
      section("Tint of things while there is a simulation", [
        ...STATES.map(([state, name, what]) => line(element("span", {}, element("i", { class: `swatch ${state}` }), name), what)),
        element("p", { class: "note" }, "The view options colour things all over; T turns it off."),
      ]),
      ...[...groups].map(([title, group]) => section(title, group.map((action) => line(keyButton(parts, action), action.label)))),
    ),
    element(
      "div",
      { class: "dialog-buttons" },
      element("span", { class: "note" }, "Click on a key to change it."),
      element("button", { onclick: () => (parts.preferences.set("keys", {}), dialog.close()) }, "Restore all keys"),
    ),
  );
}

function keyButton(parts: Pick<Parts, "preferences">, action: UserAction): HTMLElement {
  const button = element("button", { class: "key", "aria-label": `Key of “${action.label}”` }, keysOf(parts, action).join(" or "));
  button.addEventListener("click", () => {
    button.textContent = "press a key";
    button.addEventListener(
      "keydown",
      (event) => {
        event.preventDefault();
        event.stopPropagation();
        if (["Shift", "Control", "Alt", "Meta"].includes(event.key)) return;
        if (event.key !== "Escape") parts.preferences.set("keys", { ...parts.preferences.get("keys"), [action.id]: keyName(event) });
        button.textContent = keysOf(parts, action).join(" or ");
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
