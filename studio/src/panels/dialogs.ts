// SPDX-License-Identifier: MIT
import { icon } from "../tools/icons";
import { element, show } from "./element";
import { dateLocale, t } from "../language";

/** A modal dialog with a title; closes with Escape, its cross, or a click outside. */
export function openDialog(title: string, testId: string, ...contents: (Node | null)[]): HTMLDialogElement {
  const dialog = element(
    "dialog",
    { "aria-label": title, "data-testid": testId },
    element(
      "header",
      {},
      element("h2", {}, title),
      element("button", { class: "plain", "aria-label": t("Close"), onclick: () => dialog.close() }, icon("close")),
    ),
    ...contents,
  );
  dialog.addEventListener("close", () => dialog.remove());
  dialog.addEventListener("click", (event) => {
    if (event.target === dialog) dialog.close();
  });
  document.body.append(dialog);
  dialog.showModal();
  return dialog;
}

/** A row of buttons at the end of a dialog. */
export function dialogButtons(...buttons: (HTMLElement | null)[]): HTMLElement {
  return element("div", { class: "dialog-buttons" }, ...buttons);
}

/** A question for one line of text; `take` says why the text will not do, or null and the dialog closes. */
export function openTextDialog(
  title: string,
  { label, value, action, testId, note }: { label: string; value: string; action: string; testId: string; note?: string },
  take: (text: string) => Promise<string | null>,
): HTMLDialogElement {
  const input = element("input", { type: "text", value, "aria-label": label, "data-testid": `${testId}-name` });
  const error = element("p", { class: "field-error", role: "alert" });
  show(error, false);
  const submit = async (event: Event): Promise<void> => {
    event.preventDefault();
    const reason = await take(input.value.trim());
    if (reason === null) return dialog.close();
    error.textContent = reason;
    show(error, true);
  };
  const form = element(
    "form",
    { onsubmit: submit },
    element("label", {}, label, input),
    error,
    note ? element("p", { class: "note" }, note) : null,
    dialogButtons(element("button", { type: "button", onclick: () => dialog.close() }, t("Cancel")), element("button", { class: "primary", type: "submit" }, action)),
  );
  const dialog = openDialog(title, `${testId}-dialog`, form);
  input.focus();
  input.select();
  return dialog;
}

/** A date and time of the protocol for people; empty where there is none. */
export function dateText(time: string | null): string {
  if (!time) return "";
  const date = new Date(time);
  return Number.isNaN(date.getTime()) ? "" : date.toLocaleString(dateLocale, { dateStyle: "medium", timeStyle: "short" });
}
