// SPDX-License-Identifier: MIT
import { CommandRefused, reasonText } from "../connection/connection";
import type { AttributeEdit, AttributeEntry } from "../connection/messages";
import { commonComponents } from "../document/components";
import type { Parts } from "../parts";
import { type AttributeEdits, AttributeRow, type SharedAttribute } from "./attribute_row";
import { type AttributeSubject, CatalogueModel, SelectedEntities } from "./attribute_subject";
import { openApply } from "./apply_dialog";
import { element, setText, show } from "./element";

const REFRESH_DELAY_MS = 60;

/** The physical attributes of what is selected, or of the model picked in the catalogue, grouped by kind. */
export class AttributeList implements AttributeEdits {
  readonly root = element("section", { class: "attributes", "data-testid": "attributes", "aria-label": "Physical attributes" });
  private readonly note = element("p", { class: "note" });
  private readonly groups = element("div", {});
  private rows = new Map<string, AttributeRow>();
  private shape = "";
  private timer = 0;
  private generation = 0;
  /** Groups that are closed at first; few people look for the last one. */
  private readonly closed = new Set(["motion"]);

  constructor(private readonly parts: Pick<Parts, "preferences" | "server" | "notices" | "document" | "playback" | "selection" | "picked" | "found" | "models">) {
    this.root.append(this.note, this.groups);
    parts.selection.changed.on(() => this.refresh());
    parts.picked.changed.on(() => this.refresh());
    parts.document.changed.on(({ all, entities }) => {
      if (all || entities.some((index) => parts.selection.has(index))) this.refreshSoon();
    });
    parts.playback.changed.on(() => this.refreshSoon());
    parts.server.catalogChanged.on(() => this.refreshSoon());
  }

  set(name: string, value: AttributeEdit): Promise<string | null> {
    return this.edit((subject) => subject.set(name, value));
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
    show(this.root, subject !== null);
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
  }

  private build(shared: SharedAttribute[], canApply: boolean): void {
    this.rows = new Map();
    const groups = new Map<string, HTMLElement>();
    for (const { entry } of shared) {
      const row = new AttributeRow(entry, this, canApply);
      this.rows.set(entry.name, row);
      let group = groups.get(entry.kind);
      if (!group) {
        group = this.makeGroup(entry.kind, entry.kind_label);
        groups.set(entry.kind, group);
      }
      group.append(row.root);
    }
    this.groups.replaceChildren(...groups.values());
  }

  /** A group of attributes, open or closed as the last group of that kind was. */
  private makeGroup(kind: string, title: string): HTMLElement {
    const group = element("details", { class: "group", open: !this.closed.has(kind) }, element("summary", {}, title));
    group.addEventListener("toggle", () => (group.open ? this.closed.delete(kind) : this.closed.add(kind)));
    return group;
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
    }];
  });
}
