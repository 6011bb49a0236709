// SPDX-License-Identifier: MIT
import type { Notice } from "../connection/notices";
import type { Parts } from "../parts";
import { element } from "./element";
import { icon } from "../tools/icons";
import { t } from "../language";

const SHOWN_MS = { info: 3500, warning: 8000, error: 12000 };
/** A message with a button stays longer, so that its reader can decide. */
const WITH_ACTION_MS = 12000;
const MOST = 4;

/** Short messages in the corner: what went wrong, why, and what to do. */
export class Toasts {
  readonly root = element("div", { class: "toasts", role: "log", "aria-live": "polite", "aria-label": t("Messages") });

  constructor(parts: Pick<Parts, "notices">) {
    parts.notices.told.on((notice) => this.show(notice));
  }

  private show(notice: Notice): void {
    // The same message again replaces the old one, and so stays longer.
    for (const other of this.root.children) if (other.getAttribute("data-text") === notice.text) other.remove();
    const toast = element(
      "div",
      { class: `toast ${notice.level}`, "data-testid": `toast-${notice.level}`, "data-text": notice.text },
      element("div", { class: "toast-text" }, element("p", {}, notice.text), notice.remedy ? element("p", { class: "remedy" }, notice.remedy) : null),
      notice.action
        ? element("button", { class: "text-button", "data-testid": "toast-action", onclick: () => (toast.remove(), notice.action!.run()) }, notice.action.label)
        : null,
      element("button", { class: "plain", "aria-label": t("Close message"), onclick: () => toast.remove() }, icon("close")),
    );
    this.root.append(toast);
    while (this.root.children.length > MOST) this.root.firstElementChild!.remove();
    setTimeout(() => toast.remove(), notice.action ? WITH_ACTION_MS : SHOWN_MS[notice.level]);
  }
}
