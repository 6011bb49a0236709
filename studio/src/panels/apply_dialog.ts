// SPDX-License-Identifier: MIT
import { reasonText } from "../connection/connection";
import type { AttributeEntry, AttributeValue, ChangeSummary, ModelChoice } from "../connection/messages";
import type { Parts } from "../parts";
import { fieldFor, wholeValue } from "./attribute_row";
import { openDialog } from "./dialogs";
import { element, setText, show } from "./element";
import { userNameField } from "./user_name";
import { countText, t, translateServerText } from "../language";

const NAMES_SHOWN = 8;
const REFUSALS_SHOWN = 4;

interface Scope {
  id: string;
  text: string;
  models: ModelChoice;
  total: number;
}

/** Sets a value for models of the catalogue: these, all that are found, or a whole category; shows first what would change. */
export async function openApply(parts: Pick<Parts, "preferences" | "server" | "found" | "models">, entry: AttributeEntry, keys: string[]): Promise<void> {
  const scopes = await scopesOf(parts, keys);
  if (scopes.length > 0) new ApplyDialog(parts, entry, scopes);
}

class ApplyDialog {
  private value: AttributeValue;
  private scope: Scope;
  private resets = false;
  private skip = false;
  private asked = 0;
  private working = false;
  private readonly field;
  private readonly preview = element("div", { class: "apply-preview", role: "status", "data-testid": "apply-preview" });
  private readonly problem = element("p", { class: "field-error", role: "alert" });
  private readonly bar = element("progress", { "aria-label": t("Models changed") });
  private readonly confirm = element("button", { class: "primary", type: "submit", "data-testid": "apply-confirm" }, t("Change"));
  private readonly cancel = element("button", { type: "button", "data-testid": "apply-cancel", onclick: () => this.leave() }, t("Cancel"));
  private readonly choices: HTMLFieldSetElement;
  private readonly dialog: HTMLDialogElement;

  constructor(
    private readonly parts: Pick<Parts, "preferences" | "server">,
    private readonly entry: AttributeEntry,
    scopes: Scope[],
  ) {
    // The value without the entity's scale, because the model has none.
    this.value = entry.of_model ?? entry.value;
    this.scope = scopes[0]!;
    this.field = fieldFor(entry, (edit) => {
      this.value = wholeValue(edit, this.value);
      void this.ask();
    });
    this.field.set(this.value as never);
    this.choices = element("fieldset", { class: "apply-choices" }, this.valueChoice(), this.scopeChoice(scopes), this.nameChoice());
    show(this.bar, false);
    const form = element("form", { class: "apply", onsubmit: (event: Event) => (event.preventDefault(), void this.carryOut()) });
    form.append(this.choices, this.preview, this.problem, this.bar, element("div", { class: "dialog-buttons" }, this.cancel, this.confirm));
    this.dialog = openDialog(t("Apply {{label}} to models", { label: translateServerText(entry.label) || entry.name }), "apply-dialog", form);
    const ended = parts.server.progress.on(({ client, done, total }) => client === parts.server.client && this.showProgress(done, total));
    this.dialog.addEventListener("close", ended);
    this.dialog.addEventListener("cancel", (event) => this.working && event.preventDefault());
    void this.ask();
  }

  private valueChoice(): HTMLElement {
    const radio = (resets: boolean, testId: string) =>
      element("input", { type: "radio", name: "value", checked: resets === this.resets, "data-testid": testId, onchange: () => ((this.resets = resets), void this.ask()) });
    const scaled = this.entry.of_model !== undefined && JSON.stringify(this.entry.of_model) !== JSON.stringify(this.entry.value);
    const set = element("div", { class: "apply-value" }, element("label", { class: "choice" }, radio(false, "apply-set"), t("Set to")), this.field.root);
    return element(
      "div",
      { role: "radiogroup", "aria-label": t("Value") },
      set,
      scaled ? element("p", { class: "note indented" }, t("The value without the entity's scale, as the model has it.")) : null,
      element("label", { class: "choice" }, radio(true, "apply-reset"), t("Back to the automatic value of each model")),
    );
  }

  private scopeChoice(scopes: Scope[]): HTMLElement {
    const row = (scope: Scope) =>
      element(
        "label",
        { class: "choice" },
        element("input", { type: "radio", name: "scope", checked: scope === this.scope, "data-testid": `apply-scope-${scope.id}`, onchange: () => ((this.scope = scope), void this.ask()) }),
        element("span", { class: "scope-text" }, scope.text),
        element("span", { class: "note" }, t("{{count, number}} models", { count: scope.total })),
      );
    return element("div", { role: "radiogroup", "aria-label": t("Models") }, element("h3", {}, t("For")), ...scopes.map(row));
  }

  private nameChoice(): HTMLElement {
    return element("label", { class: "apply-name" }, element("span", {}, t("In the history as")), userNameField(this.parts));
  }

  private request(dry_run: boolean) {
    const attributes = [{ name: this.entry.name, value: this.resets ? null : this.value }];
    return this.parts.server.request("catalog.change", { models: this.scope.models, attributes, skip: this.skip, dry_run });
  }

  /** Asks the server what would change; an answer to an older question is not shown. */
  private async ask(): Promise<void> {
    const asked = ++this.asked;
    this.confirm.disabled = true;
    try {
      const summary = await this.request(true);
      if (asked === this.asked) this.showPreview(summary);
    } catch (error) {
      if (asked !== this.asked) return;
      this.preview.replaceChildren(element("p", { class: "field-error", role: "alert" }, reasonText(error as Error)));
    }
  }

  private showPreview(summary: ChangeSummary): void {
    const { changed, unchanged, refused, chosen } = summary;
    // Where some models refuse, nothing changes unless the user skips them.
    const stopped = refused > 0 && !this.skip;
    const others = chosen - refused;
    const lines: (HTMLElement | null)[] = [];
    if (!stopped) {
      const changes = t("{{count, number}} models change", { count: changed });
      const already = this.resets ? t("{{count, number}} have it already", { count: unchanged }) : t("{{count, number}} have this value already", { count: unchanged });
      lines.push(element("p", { class: "apply-count" }, changed === 0 && unchanged > 0 ? t("Nothing changes: all have it already.") : unchanged > 0 ? t("{{changes}}; {{already}}.", { changes, already }) : t("{{changes}}.", { changes })));
      lines.push(nameList(summary.models.map(({ name }) => name), changed, NAMES_SHOWN));
      lines.push(this.sceneNote(summary));
    }
    if (refused > 0) {
      const text = stopped ? t("{{count, number}} models cannot have it, so nothing would be changed:", { count: refused }) : t("{{count, number}} models cannot have it and stay as they are:", { count: refused });
      const reasons = summary.refusals.slice(0, REFUSALS_SHOWN).map(({ name, why }) => element("li", {}, `${name}: ${translateServerText(why)}`));
      if (refused > reasons.length) reasons.push(element("li", {}, t("and {{number}} more", { number: countText(refused - reasons.length) })));
      const box = element("input", { type: "checkbox", checked: this.skip, "data-testid": "apply-skip", onchange: () => ((this.skip = box.checked), void this.ask()) });
      lines.push(element("p", { class: "apply-refused" }, text), element("ul", { class: "apply-reasons" }, ...reasons));
      if (others > 0) lines.push(element("label", { class: "choice" }, box, t("Change the other {{others}}", { others: countText(others) })));
    }
    this.preview.replaceChildren(...lines.filter((line) => line !== null));
    this.confirm.disabled = stopped || changed === 0;
    setText(this.confirm, stopped || changed === 0 ? t("Change") : t("Change {{count, number}} models", { count: changed }));
  }

  /** Says what happens to entities that are in the scene already. */
  private sceneNote({ entities: { following, keeping } }: ChangeSummary): HTMLElement {
    const parts = [];
    if (following > 0) parts.push(t("{{count, number}} things in this scene follow at once.", { count: following }));
    if (keeping > 0) parts.push(t("{{count, number}} things have values of their own and keep them.", { count: keeping }));
    parts.push(t("Other scenes follow when they are opened next; a value set for a single entity always stays."));
    return element("p", { class: "note" }, parts.join(" "));
  }

  private async carryOut(): Promise<void> {
    if (this.working || this.confirm.disabled) return;
    this.working = true;
    this.choices.disabled = this.confirm.disabled = true;
    setText(this.cancel, t("Stop"));
    setText(this.problem, "");
    this.bar.removeAttribute("value");
    show(this.bar, true);
    try {
      const summary = await this.request(false);
      this.working = false;
      // Models may have been added since the preview: then ask again.
      if (summary.batch !== null || summary.refused === 0) return this.dialog.close();
    } catch (error) {
      setText(this.problem, reasonText(error as Error));
    }
    this.working = this.choices.disabled = false;
    setText(this.cancel, t("Cancel"));
    show(this.bar, false);
    await this.ask();
  }

  private showProgress(done: number, total: number): void {
    this.bar.max = total;
    this.bar.value = done;
    setText(this.confirm, t("{{done}} of {{total}}", { done: countText(done), total: countText(total) }));
  }

  private leave(): void {
    if (this.working) void this.parts.server.command("catalog.stop", {});
    else this.dialog.close();
  }
}

/** The sets of models that a change can be for: these models, those that the browser has found, their category. */
async function scopesOf(parts: Pick<Parts, "server" | "found" | "models">, keys: string[]): Promise<Scope[]> {
  const models = await Promise.allSettled(keys.map((key) => parts.models.summary(key)));
  const known = models.flatMap((answer) => (answer.status === "fulfilled" ? [answer.value] : []));
  if (known.length === 0) return [];
  const own = known.length === 1 ? t("This model: {{name}}", { name: known[0]!.name }) : t("The models of the selection");
  const scopes: Scope[] = [{ id: "model", text: own, models: { keys: known.map(({ key }) => key) }, total: known.length }];
  const { found } = parts;
  scopes.push({ id: "found", text: "all" in found.models ? t("All models of the catalogue") : t("All that the browser shows: {{text}}", { text: found.text }), models: found.models, total: await totalOf(parts, found.models) });
  for (const category of new Set(known.map((model) => model.category)))
    if (category) scopes.push({ id: "category", text: t("All of the category “{{category}}”", { category: translateServerText(category) }), models: { category }, total: await totalOf(parts, { category }) });
  return scopes.filter(({ total }) => total > 0);
}

async function totalOf(parts: Pick<Parts, "server">, models: ModelChoice): Promise<number> {
  if ("keys" in models) return models.keys.length;
  const answer = await parts.server.command("catalog.search", { ...("all" in models ? {} : models), limit: 1 });
  return answer?.total ?? 0;
}

/** The first names; a name that several models have is listed once. */
function nameList(names: string[], total: number, most: number): HTMLElement {
  const times = new Map<string, number>();
  for (const name of names) times.set(name, (times.get(name) ?? 0) + 1);
  const shown = [...times].slice(0, most);
  const rest = total - shown.reduce((sum, [, many]) => sum + many, 0);
  const items = shown.map(([name, many]) => element("li", {}, many > 1 ? `${name} × ${many}` : name));
  if (rest > 0 && shown.length > 0) items.push(element("li", { class: "more" }, t("and {{number}} more", { number: countText(rest) })));
  return element("ul", { class: "apply-names", "data-testid": "apply-names" }, ...items);
}
