// SPDX-License-Identifier: MIT
import type { AttributeEntry, AttributeValue } from "../connection/messages";
import { element, setText, show } from "./element";
import { type Field, numberField, numberText, truthField, vectorField, wordField } from "./fields";
import { icon } from "./icons";

/** One attribute as the selected entities have it. */
export interface SharedAttribute {
  entry: AttributeEntry;
  /** Whether all selected entities have the same value. */
  same: boolean;
  overridden: boolean;
}

export interface AttributeEdits {
  set(name: string, value: AttributeValue): Promise<string | null>;
  reset(name: string): Promise<string | null>;
}

/** A physical attribute: its value to edit, where that comes from and how sure it is, and the way back. */
export class AttributeRow {
  readonly root: HTMLElement;
  private readonly field: Field<never>;
  private readonly level = element("span", { class: "level" });
  private readonly source = element("span", { class: "source" });
  private readonly reset: HTMLButtonElement;

  constructor(
    entry: AttributeEntry,
    private readonly edits: AttributeEdits,
  ) {
    this.field = fieldFor(entry, (value) => void this.commit(entry.name, value)) as Field<never>;
    this.reset = element(
      "button",
      {
        class: "reset-button",
        "aria-label": `${entry.label}: back to the automatic value`,
        "data-testid": `reset-${entry.name}`,
        onclick: () => void this.goBack(entry.name),
      },
      icon("undo"),
    );
    this.root = element(
      "div",
      { class: "attribute", "data-testid": `attribute-${entry.name}` },
      element("span", { class: "attribute-label", title: `${entry.help}\n(${entry.name})` }, entry.label || entry.name),
      this.field.root,
      this.reset,
      element("span", { class: "origin" }, this.level, this.source),
    );
  }

  show({ entry, same, overridden }: SharedAttribute): void {
    this.field.set((same ? entry.value : null) as never);
    setText(this.level, same ? entry.level : "mixed");
    this.level.dataset["level"] = same ? entry.level : "mixed";
    const interval = same ? intervalText(entry) : "";
    setText(this.source, same ? [interval, entry.source].filter(Boolean).join(" · ") : "the selected entities differ");
    this.source.title = same ? `${entry.source}${interval ? `\n80 % interval ${interval}` : ""}` : "";
    show(this.reset, overridden);
    this.reset.title = entry.automatic === null ? "Back to the automatic value" : `Back to the automatic value, ${valueText(entry.automatic)}`;
  }

  private async commit(name: string, value: AttributeValue): Promise<void> {
    this.field.setError(await this.edits.set(name, value));
  }

  private async goBack(name: string): Promise<void> {
    this.field.setError(await this.edits.reset(name));
  }
}

function fieldFor(entry: AttributeEntry, commit: (value: AttributeValue) => void): Field<never> {
  const label = entry.label || entry.name;
  const made = (() => {
    switch (entry.type) {
      case "number":
        return numberField(label, entry.unit, commit);
      case "truth":
        return truthField(label, commit);
      case "vector":
        return vectorField([`${label} x`, `${label} y`, `${label} z`], entry.unit, commit);
      case "tensor":
        return tensorField(label, entry.unit, commit);
      case "word":
        return wordField(label, entry.choices ?? [], commit);
    }
  })();
  return made as unknown as Field<never>;
}

/** The six numbers of a symmetric tensor: the diagonal, and below it xy, xz, yz. */
function tensorField(label: string, unit: string, commit: (value: number[][]) => void): Field<number[][]> {
  let diagonal: readonly number[] = [0, 0, 0];
  let mixed: readonly number[] = [0, 0, 0];
  const send = (): void => {
    const [xx, yy, zz] = diagonal as [number, number, number];
    const [xy, xz, yz] = mixed as [number, number, number];
    commit([
      [xx, xy, xz],
      [xy, yy, yz],
      [xz, yz, zz],
    ]);
  };
  const upper = vectorField(["xx", "yy", "zz"].map((part) => `${label} ${part}`), unit, (value) => ((diagonal = value), send()));
  const lower = vectorField(["xy", "xz", "yz"].map((part) => `${label} ${part}`), unit, (value) => ((mixed = value), send()));
  return {
    root: element("span", { class: "tensor" }, upper.root, lower.root),
    setError: upper.setError,
    set(next) {
      if (next) {
        diagonal = [next[0]![0]!, next[1]![1]!, next[2]![2]!];
        mixed = [next[0]![1]!, next[0]![2]!, next[1]![2]!];
      }
      upper.set(next && diagonal);
      lower.set(next && mixed);
    },
  };
}

function intervalText(entry: AttributeEntry): string {
  if (entry.low === null || entry.high === null || entry.low === undefined || entry.high === undefined) return "";
  // Bounds are estimates: three figures say all they know.
  const text = (bound: number) => numberText(Number(bound.toPrecision(3)));
  return `${text(entry.low)} … ${text(entry.high)}`;
}

function valueText(value: AttributeValue): string {
  if (typeof value === "number") return numberText(value);
  if (Array.isArray(value)) return value.flat().map(numberText).join(", ");
  return String(value);
}
