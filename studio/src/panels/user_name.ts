// SPDX-License-Identifier: MIT
import type { Parts } from "../parts";
import { element } from "./element";

/** This user's name in the history of changes; kept in the browser. */
export function userNameField(parts: Pick<Parts, "preferences" | "server">): HTMLInputElement {
  const input = element("input", {
    type: "text",
    value: parts.preferences.get("userName"),
    placeholder: `studio ${parts.server.client}`,
    maxlength: 40,
    autocomplete: "off",
    class: "user-name",
    "aria-label": "Your name in the history of changes",
    "data-testid": "user-name",
    onchange: () => parts.preferences.set("userName", input.value.trim()),
  });
  return input;
}
