// SPDX-License-Identifier: MIT
import type { Preferences } from "../preferences";
import { element } from "./element";

type Child = Node | string | null;

/** While a filter opens groups to show what it found, that is not remembered. */
export const FILTERING = "filtering";

/** Whether the user has the group open. */
export function isUnfolded(preferences: Preferences, id: string, openAtFirst: boolean): boolean {
  return preferences.get("folds")[id] ?? openAtFirst;
}

/** A group of a panel that can be folded; it stays as the user left it. */
export function foldingGroup(preferences: Preferences, id: string, title: string, openAtFirst: boolean, ...children: Child[]): HTMLDetailsElement {
  const group = element("details", { class: "group", "data-group": id, open: isUnfolded(preferences, id, openAtFirst) }, element("summary", {}, title), ...children);
  group.dataset["first"] = String(openAtFirst);
  group.addEventListener("toggle", () => {
    if (group.closest(`.${FILTERING}`) || group.open === isUnfolded(preferences, id, openAtFirst)) return;
    preferences.set("folds", { ...preferences.get("folds"), [id]: group.open });
  });
  return group;
}

/** Folds a group as the user left it, after a filter had opened it. */
export function refold(preferences: Preferences, group: HTMLDetailsElement): void {
  group.open = isUnfolded(preferences, group.dataset["group"] ?? "", group.dataset["first"] === "true");
}
