// SPDX-License-Identifier: MIT
// Our whole user interface library: functions that make elements. Panels keep references to the elements that they change.

type Child = Node | string | null | undefined | false;
type Listener = (event: never) => void;
/** Attributes; `on…` listeners, `class`, and booleans that are present or absent. */
type Attributes = Record<string, string | number | boolean | undefined | Listener>;

export function element<Tag extends keyof HTMLElementTagNameMap>(
  tag: Tag,
  attributes: Attributes = {},
  ...children: Child[]
): HTMLElementTagNameMap[Tag] {
  const made = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) {
    if (typeof value === "function") made.addEventListener(name.replace(/^on/, ""), value as EventListener);
    else if (value === true) made.setAttribute(name, "");
    else if (value !== false && value !== undefined) made.setAttribute(name, String(value));
  }
  for (const child of children) if (child) made.append(child);
  return made;
}

/** Stands in a text where an element goes. */
export const GAP = "\u{fffc}";

/** The children of an element that shows a text with another element at its gap. */
export function around(text: string, inner: HTMLElement): (string | HTMLElement)[] {
  const [before = "", after = ""] = text.split(GAP);
  return [before, inner, after];
}

/** Shows or hides an element that stays in the document. */
export function show(shown: HTMLElement, visible: boolean): void {
  shown.hidden = !visible;
}

/** Sets the text only where it differs: cheaper, and screen readers stay quiet. */
export function setText(target: HTMLElement, text: string): void {
  if (target.textContent !== text) target.textContent = text;
}
