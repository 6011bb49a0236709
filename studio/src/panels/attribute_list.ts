// SPDX-License-Identifier: MIT
import { CommandRefused } from "../connection/connection";
import type { AttributeEntry, AttributeValue } from "../connection/messages";
import type { Studio } from "../studio";
import { type AttributeEdits, AttributeRow, type SharedAttribute } from "./attribute_row";
import { element, setText, show } from "./element";

/** More selected entities than this are shown by the first of them: asking for all would take long. */
const MOST_ASKED = 32;
const REFRESH_DELAY_MS = 60;
const KIND_TITLES: Record<string, string> = {
  identity: "What it is",
  mass: "Mass",
  shape: "Collision shape",
  surface: "Surface",
  motion: "Motion",
  soft: "Soft body",
  cloth: "Cloth",
  rope: "Rope",
  fluid: "Fluid",
  grain: "Grains",
};

/** The physical attributes of what is selected, grouped by kind. */
export class AttributeList implements AttributeEdits {
  readonly root = element("section", { class: "attributes", "data-testid": "attributes", "aria-label": "Physical attributes" });
  private readonly note = element("p", { class: "note" });
  private readonly groups = element("div", {});
  private rows = new Map<string, AttributeRow>();
  private shape = "";
  private timer = 0;
  private generation = 0;
  /** Kinds that are folded; few people look for the last one. */
  private readonly closed = new Set(["motion"]);

  constructor(private readonly studio: Studio) {
    this.root.append(this.note, this.groups);
    studio.selection.changed.on(() => this.refresh());
    studio.document.changed.on(({ all, entities }) => {
      if (all || entities.some((index) => studio.selection.has(index))) this.refreshSoon();
    });
    studio.simulationChanged.on(() => this.refreshSoon());
  }

  async set(name: string, value: AttributeValue): Promise<string | null> {
    return this.edit(() => this.studio.connection.request("entity.set_attribute", { indices: this.indices(), name, value }));
  }

  async reset(name: string): Promise<string | null> {
    return this.edit(() => this.studio.connection.request("entity.reset_attribute", { indices: this.indices(), name }));
  }

  private indices(): number[] {
    return [...this.studio.selection.indices];
  }

  /** Carries out an edit; the reason where the server refuses it belongs beside the field. */
  private async edit(request: () => Promise<unknown>): Promise<string | null> {
    try {
      await request();
      this.refreshSoon();
      return null;
    } catch (error) {
      if (!(error instanceof CommandRefused)) this.studio.report(error as Error);
      const { why, remedy } = error instanceof CommandRefused ? error.error : { why: (error as Error).message, remedy: "" };
      return remedy ? `${why}. ${remedy}` : why;
    }
  }

  private refreshSoon(): void {
    clearTimeout(this.timer);
    this.timer = window.setTimeout(() => void this.refresh(), REFRESH_DELAY_MS);
  }

  private async refresh(): Promise<void> {
    const generation = ++this.generation;
    const indices = this.indices();
    show(this.root, indices.length > 0);
    if (indices.length === 0 || !this.studio.connection.isOpen) return;
    const asked = indices.slice(0, MOST_ASKED);
    const answers = await Promise.allSettled(asked.map((index) => this.studio.connection.request("entity.attributes", { index })));
    if (generation !== this.generation) return;
    const sets = answers.flatMap((answer) => (answer.status === "fulfilled" ? [answer.value.attributes] : []));
    const failed = answers.find((answer) => answer.status === "rejected");
    setText(this.note, noteText(indices.length, failed?.reason as Error | undefined));
    show(this.note, this.note.textContent !== "");
    this.fill(shareAttributes(sets));
  }

  /** Rows stay while the same attributes are shown, so that the keyboard's place is not lost. */
  private fill(shared: SharedAttribute[]): void {
    const shape = `${this.studio.selection.indices.join()}:${shared.map(({ entry }) => `${entry.name}/${entry.type}`).join()}`;
    if (shape !== this.shape) {
      this.shape = shape;
      this.build(shared);
    }
    for (const each of shared) this.rows.get(each.entry.name)?.show(each);
  }

  private build(shared: SharedAttribute[]): void {
    this.rows = new Map();
    const groups = new Map<string, HTMLElement>();
    for (const { entry } of shared) {
      const row = new AttributeRow(entry, this);
      this.rows.set(entry.name, row);
      let group = groups.get(entry.kind);
      if (!group) {
        group = this.makeGroup(entry.kind);
        groups.set(entry.kind, group);
      }
      group.append(row.root);
    }
    this.groups.replaceChildren(...groups.values());
  }

  /** A group of attributes, open or closed as its user left the last one of that kind. */
  private makeGroup(kind: string): HTMLElement {
    const group = element("details", { class: "group", open: !this.closed.has(kind) }, element("summary", {}, KIND_TITLES[kind] ?? kind));
    group.addEventListener("toggle", () => (group.open ? this.closed.delete(kind) : this.closed.add(kind)));
    return group;
  }
}

function noteText(selected: number, failure: Error | undefined): string {
  if (failure) return failure.message;
  return selected > MOST_ASKED ? `Values of the first ${MOST_ASKED} of ${selected} entities; an edit changes all of them.` : "";
}

/** The attributes that all have, with whether their values agree. */
export function shareAttributes(sets: AttributeEntry[][]): SharedAttribute[] {
  const [first, ...others] = sets;
  if (!first) return [];
  const byName = others.map((set) => new Map(set.map((entry) => [entry.name, entry])));
  return first.flatMap((entry) => {
    const rest = byName.map((set) => set.get(entry.name));
    if (rest.some((other) => other === undefined)) return [];
    const text = JSON.stringify(entry.value);
    return [{
      entry,
      same: rest.every((other) => JSON.stringify(other!.value) === text),
      overridden: entry.overridden || rest.some((other) => other!.overridden),
    }];
  });
}
