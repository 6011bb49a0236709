// SPDX-License-Identifier: MIT
import type { Parts } from "../parts";
import { element } from "./element";
import { t } from "../language";

/** This user's name in the history of changes; kept in the browser. */
export function userNameField(parts: Pick<Parts, "preferences" | "server">): HTMLInputElement {
  const input = element("input", {
    type: "text",
    value: parts.preferences.get("userName"),
    placeholder: t("studio {{client}}", { client: parts.server.client }),
    maxlength: 40,
    autocomplete: "off",
    class: "user-name",
    "aria-label": t("Your name in the history of changes"),
    "data-testid": "user-name",
    onchange: () => parts.preferences.set("userName", input.value.trim()),
  });
  return input;
}
