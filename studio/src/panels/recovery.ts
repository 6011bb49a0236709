// SPDX-License-Identifier: MIT
// Work that was not saved when its program ended, or when another scene was opened: it is offered at the start.
import type { Recovery } from "../connection/messages";
import type { Parts } from "../parts";
import { dateText, dialogButtons, openDialog } from "./dialogs";
import { element } from "./element";
import { t } from "../language";

export function editsText(edits: number | undefined): string {
  return edits === undefined ? "" : t("{{count, number}} edits", { count: edits });
}

/** Removes unsaved work for good; whether it was. */
export async function discardRecovery(parts: Pick<Parts, "server">, name: string): Promise<boolean> {
  return (await parts.server.command("scene.discard", { name })) !== undefined;
}

/** Offers the recoveries that the user does not know of; `open` opens one of them. */
export function offerRecoveries(parts: Pick<Parts, "preferences" | "server">, found: readonly Recovery[], open: (name: string) => void): void {
  const known = parts.preferences.get("recoveriesKnown");
  const fresh = found.filter(({ name }) => !known.includes(name));
  if (fresh.length === 0 || document.querySelector("[data-testid=recovery-dialog]")) return;

  const list = element("ul", { class: "recoveries" });
  const rowOf = ({ name, title, modified, edits }: Recovery): HTMLElement => {
    const discard = async (): Promise<void> => {
      if (!(await discardRecovery(parts, name))) return;
      row.remove();
      if (list.children.length === 0) dialog.close();
    };
    const row = element(
      "li",
      { class: "recovery-row", "data-testid": `recovery-${name}` },
      element("span", { class: "recovery-text" }, element("strong", {}, title || name), element("span", { class: "note" }, [dateText(modified), editsText(edits)].filter(Boolean).join(" · "))),
      element("button", { class: "primary", "data-testid": "recovery-open", onclick: () => (dialog.close(), open(name)) }, t("Open")),
      element("button", { "data-testid": "recovery-discard", onclick: () => void discard() }, t("Discard")),
    );
    return row;
  };
  list.append(...fresh.map(rowOf));
  const dialog = openDialog(
    t("Unsaved work was found"),
    "recovery-dialog",
    list,
    element("p", { class: "note" }, t("What you keep for later is under “Recovered” in “Open a scene”.")),
    dialogButtons(element("button", { "data-testid": "recovery-later", onclick: () => dialog.close() }, t("Keep for later"))),
  );
  // Remembered at once: the page may be left before the dialog tells that it was closed. Names of what is gone are forgotten.
  parts.preferences.set("recoveriesKnown", found.map(({ name }) => name));
  list.querySelector("button")?.focus();
}
