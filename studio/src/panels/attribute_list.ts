// SPDX-License-Identifier: MIT
import { CommandRefused, reasonText } from "../connection/connection";
import type { AttributeEdit, AttributeEntry } from "../connection/messages";
import { commonComponents } from "../document/components";
import type { Parts } from "../parts";
import { type AttributeEdits, AttributeRow, type SharedAttribute } from "./attribute_row";
import { type AttributeSubject, CatalogueModel, SelectedEntities } from "./attribute_subject";
import { openApply } from "./apply_dialog";
import { element, setText, show } from "./element";
import type { Change } from "./fields";
import { foldingGroup } from "./folding";
import { t, translateServerText } from "../language";

const REFRESH_DELAY_MS = 60;

/** The few values that matter first, of whatever kind a thing is; in this order. */
const ESSENTIALS = [
  "category", "kind", "surface_material", "mass", "friction_static", "friction_dynamic", "restitution",
  "youngs_modulus", "stretch_stiffness", "break_tension", "dynamic_viscosity", "rest_density", "grain_diameter",
];

/** The physical attributes of what is selected, or of the model picked in the catalogue: first what matters, then all others grouped by kind and folded. */
export class AttributeList implements AttributeEdits {
  /** What stands first, and the groups, which are folded at first. */
  readonly essentials = element("section", { class: "attributes essentials", "data-testid": "essentials", "aria-label": t("What matters most") });
  readonly root = element("section", { class: "attributes", "data-testid": "attributes", "aria-label": t("Physical attributes") });
  private readonly note = element("p", { class: "note" });
  private readonly groups = element("div", {});
  private rows = new Map<string, AttributeRow>();
  private shape = "";
  private timer = 0;
  private generation = 0;
  private readonly groupOf = new Map<string, HTMLElement>();

  constructor(private readonly parts: Pick<Parts, "preferences" | "server" | "notices" | "document" | "playback" | "selection" | "picked" | "found" | "models" | "warnings">) {
    this.root.append(this.groups);
    parts.selection.changed.on(() => this.refresh());
    parts.picked.changed.on(() => this.refresh());
    parts.document.changed.on(({ all, entities }) => {
      if (all || entities.some((index) => parts.selection.has(index))) this.refreshSoon();
    });
    parts.playback.changed.on(() => this.refreshSoon());
    parts.server.catalogChanged.on(() => this.refreshSoon());
    parts.warnings.changed.on(() => this.refreshSoon());
    for (const root of [this.essentials, this.root]) show(root, false);
  }

  set(name: string, value: AttributeEdit): Promise<string | null> {
    return this.edit((subject) => subject.set(name, value));
  }

  change(name: string, change: Change): Promise<string | null> {
    return this.edit((subject) => subject.change(name, change));
  }

  reset(name: string): Promise<string | null> {
    return this.edit((subject) => subject.reset(name));
  }

  apply(entry: AttributeEntry): void {
    const models = this.subject()?.models() ?? [];
    if (models.length > 0) void openApply(this.parts, entry, models);
  }

  private subject(): AttributeSubject | null {
    const { picked, selection } = this.parts;
    if (picked.model) return new CatalogueModel(this.parts, picked.model.key);
    return selection.indices.length > 0 ? new SelectedEntities(this.parts) : null;
  }

  /** Sends an edit to the server; returns the reason of a refusal, which is shown beside the field. */
  private async edit(request: (subject: AttributeSubject) => Promise<unknown>): Promise<string | null> {
    const subject = this.subject();
    if (!subject) return null;
    try {
      await request(subject);
      this.refreshSoon();
      return null;
    } catch (error) {
      if (!(error instanceof CommandRefused)) this.parts.notices.report(error as Error);
      return reasonText(error as Error);
    }
  }

  private refreshSoon(): void {
    clearTimeout(this.timer);
    this.timer = window.setTimeout(() => void this.refresh(), REFRESH_DELAY_MS);
  }

  private async refresh(): Promise<void> {
    const generation = ++this.generation;
    const subject = this.subject();
    for (const root of [this.essentials, this.root]) show(root, subject !== null);
    if (!subject || !this.parts.server.isOpen) return;
    const { sets, note } = await subject.load();
    if (generation !== this.generation) return;
    setText(this.note, note);
    show(this.note, note !== "");
    this.fill(subject, shareAttributes(sets));
  }

  /** Rows are kept while the same attributes are shown, so that the keyboard's focus is not lost. */
  private fill(subject: AttributeSubject, shared: SharedAttribute[]): void {
    const canApply = subject.models().length > 0;
    const shape = `${subject.id}:${canApply}:${shared.map(({ entry }) => `${entry.name}/${entry.type}`).join()}`;
    if (shape !== this.shape) {
      this.shape = shape;
      this.build(shared, canApply);
    }
    for (const each of shared) this.rows.get(each.entry.name)?.show(each);
    for (const [kind, group] of this.groupOf) {
      const warned = shared.filter(({ entry, warnings }) => entry.kind === kind && warnings.length > 0 && !ESSENTIALS.includes(entry.name));
      group.classList.toggle("warned", warned.length > 0);
    }
  }

  private build(shared: SharedAttribute[], canApply: boolean): void {
    this.rows = new Map(shared.map(({ entry }) => [entry.name, new AttributeRow(entry, this, canApply)]));
    this.groupOf.clear();
    for (const { entry } of shared) {
      if (ESSENTIALS.includes(entry.name)) continue;
      let group = this.groupOf.get(entry.kind);
      if (!group) {
        group = foldingGroup(this.parts.preferences, `values.${entry.kind}`, entry.kind === "identity" ? t("More about what it is") : translateServerText(entry.kind_label), false);
        this.groupOf.set(entry.kind, group);
      }
      group.append(this.rows.get(entry.name)!.root);
    }
    this.groups.replaceChildren(...this.groupOf.values());
    this.essentials.replaceChildren(this.note, ...ESSENTIALS.flatMap((name) => this.rows.get(name)?.root ?? []));
  }
}

/** The attributes that all entities have, and whether their values agree. */
export function shareAttributes(sets: AttributeEntry[][]): SharedAttribute[] {
  const [first, ...others] = sets;
  if (!first) return [];
  const byName = others.map((set) => new Map(set.map((entry) => [entry.name, entry])));
  return first.flatMap((entry) => {
    const rest = byName.map((set) => set.get(entry.name));
    if (rest.some((other) => other === undefined)) return [];
    const text = JSON.stringify(entry.value);
    const vectors = [entry, ...rest].map((each) => each!.value).filter((value) => Array.isArray(value));
    return [{
      entry,
      same: rest.every((other) => JSON.stringify(other!.value) === text),
      components: commonComponents(vectors),
      overridden: entry.overridden || rest.some((other) => other!.overridden),
      warnings: [entry, ...rest].flatMap((each) => each!.warnings ?? []).slice(0, 1),
    }];
  });
}
