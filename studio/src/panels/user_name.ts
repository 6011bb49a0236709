// SPDX-License-Identifier: MIT
import type { Studio } from "../studio";
import { element } from "./element";

/** What the history of changes calls this browser's user; kept in the browser. */
export function userNameField(studio: Studio): HTMLInputElement {
  const input = element("input", {
    type: "text",
    value: studio.preferences.get("userName"),
    placeholder: `studio ${studio.client}`,
    maxlength: 40,
    autocomplete: "off",
    class: "user-name",
    "aria-label": "Your name in the history of changes",
    "data-testid": "user-name",
    onchange: () => studio.preferences.set("userName", input.value.trim()),
  });
  return input;
}
