// SPDX-License-Identifier: MIT
import type { AttributeEntry, AttributeValue } from "../connection/messages";
import { element, setText, show } from "./element";
import { type Field, NOISE, numberField, numberText, truthField, vectorField, wordField } from "./fields";
import { icon } from "../tools/icons";

/** One attribute and its value in the selected entities. */
export interface SharedAttribute {
  entry: AttributeEntry;
  /** Whether all selected entities have the same value. */
  same: boolean;
  overridden: boolean;
}

/** Levels of confidence in a value, the highest first, and the meaning of the badge beside it. */
const LEVELS: Record<string, string> = {
  manual: "Set by hand",
  measured: "Measured",
  model: "Found in this very model: its shape, its materials, its catalogue",
  subcategory: "Usual for things of this subcategory",
  category: "Usual for things of this category",
  kind: "Usual for this physical kind",
  default: "Nothing better is known: the same for everything",
  mixed: "The selected entities have different values",
};

export interface AttributeEdits {
  set(name: string, value: AttributeValue): Promise<string | null>;
  reset(name: string): Promise<string | null>;
  /** The user asks to set this value for models of the catalogue. */
  apply(entry: AttributeEntry): void;
}

/** A physical attribute: its value to edit, the source and confidence of the value, and a button to reset it. */
export class AttributeRow {
  readonly root: HTMLElement;
  private readonly field: Field<never>;
  private readonly level = element("span", { class: "level" });
  private readonly source = element("span", { class: "source" });
  private readonly reset: HTMLButtonElement;
  private shown: AttributeEntry;

  constructor(
    entry: AttributeEntry,
    private readonly edits: AttributeEdits,
    canApply: boolean,
  ) {
    this.shown = entry;
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
    const label = entry.label || entry.name;
    const apply = element(
      "button",
      {
        class: "apply-button",
        title: `Apply ${label} to models of the catalogue…`,
        "aria-label": `Apply ${label} to models of the catalogue`,
        "data-testid": `apply-${entry.name}`,
        onclick: () => this.edits.apply(this.shown),
      },
      icon("apply"),
    );
    this.root = element(
      "div",
      { class: "attribute", "data-testid": `attribute-${entry.name}` },
      element("span", { class: "attribute-label", title: `${entry.help}${rangeText(entry)}\n(${entry.name})` }, label),
      this.field.root,
      canApply ? apply : null,
      this.reset,
      element("span", { class: "origin" }, this.level, this.source),
    );
  }

  show({ entry, same, overridden }: SharedAttribute): void {
    this.shown = entry;
    this.field.set((same ? entry.value : null) as never);
    const level = same ? entry.level : "mixed";
    setText(this.level, level);
    this.level.dataset["level"] = level;
    this.level.title = LEVELS[level] ?? "";
    const interval = same ? intervalText(entry) : "";
    // A source that only repeats its level tells nothing new; the meaning of the level does.
    const told = entry.source === entry.level ? (LEVELS[level] ?? "") : entry.source;
    // The value was set for the model, so that it cannot be reset for this entity alone.
    const source = level === "manual" && !overridden ? `in the catalogue, ${told}` : told;
    setText(this.source, same ? [interval, source].filter(Boolean).join(" · ") : "the selected entities differ");
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

export function fieldFor(entry: AttributeEntry, commit: (value: AttributeValue) => void): Field<never> {
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

/** A symmetric tensor, in the server's order: xx, yy, zz and, below these, xy, xz, yz. */
function tensorField(label: string, unit: string, commit: (value: number[]) => void): Field<readonly number[]> {
  let diagonal: readonly number[] = [0, 0, 0];
  let mixed: readonly number[] = [0, 0, 0];
  const send = (): void => commit([...diagonal, ...mixed]);
  const upper = vectorField(["xx", "yy", "zz"].map((part) => `${label} ${part}`), unit, (value) => ((diagonal = value), send()));
  const lower = vectorField(["xy", "xz", "yz"].map((part) => `${label} ${part}`), unit, (value) => ((mixed = value), send()));
  return {
    root: element("span", { class: "tensor" }, upper.root, lower.root),
    setError: upper.setError,
    set(next) {
      if (next) {
        diagonal = next.slice(0, 3);
        // Products of inertia of a symmetric body are zero but for rounding.
        const largest = Math.max(...diagonal.map(Math.abs));
        mixed = next.slice(3, 6).map((part) => (Math.abs(part) < NOISE * largest ? 0 : part));
      }
      upper.set(next && diagonal);
      lower.set(next && mixed);
    },
  };
}

function intervalText(entry: AttributeEntry): string {
  if (entry.low === null || entry.high === null || entry.low === undefined || entry.high === undefined) return "";
  // Bounds are estimates: three significant digits are enough.
  const text = (bound: number) => numberText(Number(bound.toPrecision(3)));
  return `${text(entry.low)} … ${text(entry.high)}`;
}

function rangeText({ range, unit }: AttributeEntry): string {
  if (!range) return "";
  const [low, high] = range.map((bound) => (bound === null ? "…" : numberText(bound)));
  return `\nFrom ${low} to ${high}${unit && unit !== "1" ? ` ${unit}` : ""}`;
}

export function valueText(value: AttributeValue): string {
  if (typeof value === "number") return numberText(value);
  if (Array.isArray(value)) return value.map(numberText).join(", ");
  return String(value);
}
