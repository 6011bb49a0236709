// SPDX-License-Identifier: MIT
import { reasonText } from "../connection/connection";
import type { ChangeBatch, ModelSummary } from "../connection/messages";
import type { Parts } from "../parts";
import { unitText, valueText } from "./attribute_row";
import { openDialog } from "./dialogs";
import { element, setText, show } from "./element";
import { dateLocale, t, translateServerText } from "../language";

const PAGE = 30;
const CHANGES_SHOWN = 12;
/** A batch with no more changes than this shows them open; where all models got the same value, one line says it. */
const CHANGES_OPEN = 1;

/** The history of the catalogue: who changed what and when, newest first, with undo. Of one model, or of all. */
export function openHistory(parts: Pick<Parts, "server">, model: ModelSummary | null = null): void {
  const list = element("ol", { class: "history", "data-testid": "history" });
  const none = element("p", { class: "note" }, model ? t("Nobody has changed this model.") : t("Nobody has changed a model of the catalogue."));
  const more = element("button", { class: "text-button", onclick: () => void load(oldest) }, t("Show older changes"));
  const intro = t("Changes by everybody who uses this database, in the Studio or on the command line. A change is undone as a whole; an undo can be undone, too.");
  const dialog = openDialog(model ? t("Changes of {{name}}", { name: model.name }) : t("Changes of the catalogue"), "history-dialog", element("p", { class: "note" }, intro), none, list, more);
  let oldest = 0;
  let shown = PAGE;
  show(none, false);
  show(more, false);

  const load = async (before: number, limit = PAGE): Promise<void> => {
    const answer = await parts.server.command("catalog.history", { limit, changes: CHANGES_SHOWN, ...(before && { before }), ...(model && { key: model.key }) });
    if (!answer) return;
    if (before === 0) list.replaceChildren();
    else shown += PAGE;
    list.append(...answer.batches.map((batch) => row(parts, batch, model !== null)));
    oldest = answer.batches.at(-1)?.batch ?? 0;
    show(more, answer.batches.length === limit);
    show(none, list.children.length === 0);
  };
  void load(0);
  const ended = parts.server.catalogChanged.on(() => void load(0, shown));
  dialog.addEventListener("close", ended);
}

function row(parts: Pick<Parts, "server">, batch: ChangeBatch, ofOne: boolean): HTMLElement {
  const isUndo = batch.command === "undo";
  const undone = batch.undone_by !== null;
  const problem = element("p", { class: "field-error", role: "alert" });
  const undo = element("button", { "data-testid": `undo-${batch.batch}` }, isUndo ? t("Redo") : t("Undo"));
  // The list is loaded again after an undo; a refusal is shown beside the batch.
  undo.addEventListener("click", () => {
    undo.disabled = true;
    parts.server.request("catalog.undo", { batch: batch.batch }).catch((error: Error) => {
      undo.disabled = false;
      setText(problem, reasonText(error));
      problem.scrollIntoView({ block: "nearest" });
    });
  });
  const values = batch.changes.map((change) =>
    element(
      "li",
      {},
      element("span", { class: "history-model" }, ofOne ? translateServerText(change.label) : `${change.name || change.key}: ${translateServerText(change.label)}`),
      element("span", {}, `${text(change, "before")} → ${text(change, "after")}`),
    ),
  );
  if (batch.values > values.length && !ofOne) values.push(element("li", { class: "note" }, t("and {{count, number}} more values", { count: batch.values - values.length })));
  const when = new Date(batch.time);
  return element(
    "li",
    { class: undone ? "undone" : "", "data-testid": `batch-${batch.batch}` },
    element(
      "div",
      { class: "history-head" },
      element("span", { class: "history-what" }, title(batch)),
      element("span", { class: "note", title: t("{{person}} ({{session}}), batch {{batch}}", { person: batch.person, session: batch.session, batch: batch.batch }) }, `${who(batch)} · ${when.toLocaleString(dateLocale, { dateStyle: "medium", timeStyle: "short" })}`),
    ),
    // A batch that was undone, or an undo that was undone itself, offers no button.
    undone ? element("span", { class: "note history-state" }, t("undone")) : batch.undoes !== null && !isUndo ? element("span", { class: "history-state" }) : undo,
    problem,
    element("details", { open: values.length <= CHANGES_OPEN }, element("summary", {}, ofOne || batch.models === 1 ? t("Values") : t("{{count, number}} models", { count: batch.models })), element("ul", {}, ...values)),
  );
}

function title(batch: ChangeBatch): string {
  const labels = [...new Set(batch.changes.map(({ label }) => translateServerText(label)))].join(t(", "));
  const first = batch.changes[0]!;
  const of = batch.models === 1 ? first.name || first.key : batch.asked || t("{{count, number}} models", { count: batch.models });
  if (batch.undoes !== null) return batch.command === "undo" ? t("Took back: {{labels}} of {{of}}", { labels, of }) : t("Did again: {{labels}} of {{of}}", { labels, of });
  if (batch.command.startsWith("reset")) return t("Reset {{labels}} of {{of}}", { labels, of });
  const same = batch.changes.every(({ after, attribute }) => attribute === first.attribute && JSON.stringify(after) === JSON.stringify(first.after));
  return same ? t("Set {{labels}} of {{of}} to {{value}}", { labels, of, value: text(first, "after") }) : t("Set {{labels}} of {{of}}", { labels, of });
}

/** The name that the user entered in the Studio; else the person's login name and the program. */
function who({ person, session }: ChangeBatch): string {
  if (session.startsWith("studio: ")) return session.slice("studio: ".length);
  return session ? `${person} (${session})` : person;
}

function text(change: ChangeBatch["changes"][number], when: "before" | "after"): string {
  const value = change[when];
  if (value === null) return t("automatic");
  const unit = unitText(change.unit);
  return unit && unit !== "1" && value !== "infinity" ? `${valueText(value, change.attribute)} ${unit}` : valueText(value, change.attribute);
}
