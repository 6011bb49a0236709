// SPDX-License-Identifier: MIT
import type { AttributeEdit, AttributeEntry, AttributeValue, ValueWarning } from "../connection/messages";
import { withTyped } from "../document/components";
import { element, setText, show } from "./element";
import { type Change, type Components, type Field, numberField, truthField, vectorField, wordField } from "./fields";
import { GROUP_LIST, NOISE, type NumberFormat, numberText, PLAIN, THRESHOLD } from "./number_text";
import { wordText } from "./words";
import { icon } from "../tools/icons";
import { t, translateServerText } from "../language";

/** One attribute and its value in the selected entities. */
export interface SharedAttribute {
  entry: AttributeEntry;
  /** Whether all selected entities have the same value. */
  same: boolean;
  /** Of a vector or tensor that differs: the components in which they agree. */
  components: Components | null;
  overridden: boolean;
  /** The first thing about it that makes no sense. */
  warnings: readonly ValueWarning[];
}

/** Levels of confidence in a value, the highest first, and the meaning of the badge beside it. */
const LEVELS: Record<string, string> = {
  manual: t("Set by hand"),
  measured: t("Measured"),
  model: t("Found in this very model: its shape, its materials, its catalogue"),
  subcategory: t("Usual for things of this subcategory"),
  category: t("Usual for things of this category"),
  kind: t("Usual for this physical kind"),
  default: t("Nothing better is known: the same for everything"),
  mixed: t("The selected entities have different values"),
};

/** The words of the badges. */
const LEVEL_NAMES: Record<string, string> = {
  manual: t("manual"),
  measured: t("measured"),
  model: t("model"),
  subcategory: t("subcategory"),
  category: t("category"),
  kind: t("kind"),
  default: t("default"),
  mixed: t("mixed"),
};

export interface AttributeEdits {
  /** Components of a vector or tensor that are null stay as they are in each entity. */
  set(name: string, value: AttributeEdit): Promise<string | null>;
  /** Changes the value of each of several entities that differ. */
  change(name: string, change: Change): Promise<string | null>;
  reset(name: string): Promise<string | null>;
  /** The user asks to set this value for models of the catalogue. */
  apply(entry: AttributeEntry): void;
}

/** Attributes whose source the user has opened; it stays open for the next thing. */
const opened = new Set<string>();

/** A physical attribute: its value to edit, a button to reset it, what makes no sense about it, and, one click away, its interval and source. */
export class AttributeRow {
  readonly root: HTMLElement;
  private readonly field: Field<never>;
  private readonly level = element("button", { class: "level", "aria-expanded": "false", onclick: () => this.openSource(!opened.has(this.shown.name)) });
  private readonly warning = element("p", { class: "value-warning", role: "note" });
  private readonly source = element("span", { class: "source" });
  private readonly reset: HTMLButtonElement;
  private shown: AttributeEntry;
  private same = true;
  /** The warning that is written, as text. */
  private warned = "";

  constructor(
    entry: AttributeEntry,
    private readonly edits: AttributeEdits,
    canApply: boolean,
  ) {
    this.shown = entry;
    this.field = fieldFor(entry, (value) => void this.commit(entry.name, value), (change) => void this.changeEach(entry.name, change)) as Field<never>;
    const label = translateServerText(entry.label) || entry.name;
    this.reset = element(
      "button",
      {
        class: "reset-button",
        "aria-label": t("{{label}}: back to the automatic value", { label }),
        "data-testid": `reset-${entry.name}`,
        onclick: () => void this.goBack(entry.name),
      },
      icon("undo"),
    );
    const apply = element(
      "button",
      {
        class: "apply-button",
        title: t("Apply {{label}} to models of the catalogue…", { label }),
        "aria-label": t("Apply {{label}} to models of the catalogue", { label }),
        "data-testid": `apply-${entry.name}`,
        onclick: () => this.edits.apply(this.shown),
      },
      icon("apply"),
    );
    this.root = element(
      "div",
      { class: "attribute", "data-testid": `attribute-${entry.name}`, "data-name": entry.name, "data-label": entry.label },
      element("span", { class: "attribute-label", title: [translateServerText(entry.help), rangeText(entry), `(${entry.name})`].filter(Boolean).join("\n") }, label),
      this.level,
      this.field.root,
      canApply ? apply : null,
      this.reset,
      this.source,
      this.warning,
    );
    this.level.dataset["testid"] = `why-${entry.name}`;
    this.openSource(opened.has(entry.name));
  }

  private openSource(open: boolean): void {
    if (open) opened.add(this.shown.name);
    else opened.delete(this.shown.name);
    show(this.source, open);
    this.level.setAttribute("aria-expanded", String(open));
  }

  /** What makes no sense, with a button that mends it where one value is to be taken back. */
  private warn(warning: ValueWarning | undefined): void {
    show(this.warning, warning !== undefined);
    this.root.classList.toggle("warned", warning !== undefined);
    if (!warning) return;
    // The same warning stays as it is: its button may be pressed just now.
    const key = JSON.stringify(warning);
    if (key === this.warned) return;
    this.warned = key;
    const { reset, remedy } = warning;
    const told = translateServerText(remedy);
    const text = told ? `${told[0]!.toUpperCase()}${told.slice(1)}` : "";
    const mend = reset ? element("button", { class: "link", "data-testid": `mend-${this.shown.name}`, onclick: () => void this.goBack(reset) }, remedy.startsWith("back to automatic") ? text : t("Back to automatic")) : null;
    this.warning.replaceChildren(t("⚠ {{why}}. ", { why: translateServerText(warning.why) }), ...(remedy && !remedy.startsWith("back to automatic") ? [t("{{remedy}}. ", { remedy: text })] : []), ...(mend ? [mend] : []));
  }

  show({ entry, same, components, overridden, warnings }: SharedAttribute): void {
    this.shown = entry;
    this.same = same;
    this.field.set((same ? entry.value : components) as never);
    const level = same ? entry.level : "mixed";
    this.level.setAttribute("aria-label", LEVEL_NAMES[level] ?? level);
    this.level.dataset["level"] = level;
    this.level.title = [LEVELS[level], t("Click: where the value is from")].filter(Boolean).join("\n");
    if (this.root.dataset["changed"] !== String(overridden)) this.root.dataset["changed"] = String(overridden);
    this.warn(warnings[0]);
    const interval = same ? intervalText(entry) : "";
    // A source that only repeats its level tells nothing new; the meaning of the level does.
    const told = entry.source === entry.level ? (LEVELS[level] ?? "") : translateServerText(entry.source);
    // The value was set for the model, so that it cannot be reset for this entity alone.
    const source = level === "manual" && !overridden ? t("in the catalogue, {{told}}", { told }) : told;
    setText(this.source, same ? [interval, source].filter(Boolean).join(" · ") : t("the selected entities differ"));
    this.source.title = same ? [translateServerText(entry.source), interval && t("80 % interval {{interval}}", { interval })].filter(Boolean).join("\n") : "";
    show(this.reset, overridden);
    this.reset.title = entry.automatic === null ? t("Back to the automatic value") : t("Back to the automatic value, {{automatic}}", { automatic: valueText(entry.automatic, entry.name) });
  }

  private async commit(name: string, edit: AttributeEdit): Promise<void> {
    this.field.setError(await this.edits.set(name, this.same ? wholeValue(edit, this.shown.value) : edit));
  }

  private async changeEach(name: string, change: Change): Promise<void> {
    this.field.setError(await this.edits.change(name, change));
  }

  private async goBack(name: string): Promise<void> {
    this.field.setError(await this.edits.reset(name));
  }
}

/** The value that an edit makes of a known one. */
export function wholeValue(edit: AttributeEdit, known: AttributeValue): AttributeValue {
  return Array.isArray(edit) ? withTyped(known as number[], edit) : edit;
}

export function fieldFor(entry: AttributeEntry, commit: (value: AttributeEdit) => void, each?: (change: Change) => void): Field<never> {
  const label = translateServerText(entry.label) || entry.name;
  const unit = unitText(entry.unit);
  const made = (() => {
    switch (entry.type) {
      case "number":
        return attributeNumber(label, unit, entry, commit, each);
      case "truth":
        return truthField(label, commit);
      case "vector":
        return vectorField([`${label} x`, `${label} y`, `${label} z`], unit, (typed) => commit([...typed]));
      case "tensor":
        return tensorField(label, unit, commit);
      case "word":
        return wordField(label, entry.choices ?? [], commit);
    }
  })();
  return made as unknown as Field<never>;
}

export function unitText(unit: string): string {
  return unit === "deg" ? "°" : unit;
}

/** The attributes that are masks of collision groups. */
const MASKS = ["collision_group", "collision_mask"];

function formatOf(name: string, range: AttributeEntry["range"]): NumberFormat {
  if (MASKS.includes(name)) return GROUP_LIST;
  return range && range[1] === null ? THRESHOLD : PLAIN;
}

/** A number; the protocol writes infinity as a word. */
function attributeNumber(label: string, unit: string, { name, range }: AttributeEntry, commit: (value: AttributeValue) => void, each?: (change: Change) => void): Field<AttributeValue> {
  const field = numberField(label, unit, (value) => commit(value === Infinity ? "infinity" : value), { format: formatOf(name, range), each });
  return { ...field, set: (next) => field.set(next === null ? null : toNumber(next)) };
}

function toNumber(value: AttributeValue): number {
  return value === "infinity" ? Infinity : value === "-infinity" ? -Infinity : Number(value);
}

/** A symmetric tensor, in the server's order: xx, yy, zz and, below these, xy, xz, yz. */
function tensorField(label: string, unit: string, commit: (typed: (number | null)[]) => void): Field<Components> {
  const none = [null, null, null];
  const upper = vectorField(["xx", "yy", "zz"].map((part) => `${label} ${part}`), unit, (typed) => commit([...typed, ...none]));
  const lower = vectorField(["xy", "xz", "yz"].map((part) => `${label} ${part}`), unit, (typed) => commit([...none, ...typed]));
  return {
    root: element("span", { class: "tensor" }, upper.root, lower.root),
    setError: upper.setError,
    set(next) {
      const diagonal = next?.slice(0, 3) ?? none;
      // Products of inertia of a symmetric body are zero but for rounding.
      const least = NOISE * Math.max(...diagonal.map((part) => Math.abs(part ?? 0)));
      upper.set(diagonal);
      lower.set(next?.slice(3, 6).map((part) => (part !== null && Math.abs(part) < least ? 0 : part)) ?? none);
    },
  };
}

function intervalText(entry: AttributeEntry): string {
  if (typeof entry.low !== "number" || typeof entry.high !== "number") return "";
  // Bounds are estimates: three significant digits are enough.
  const text = (bound: number) => numberText(Number(bound.toPrecision(3)));
  return `${text(entry.low)} … ${text(entry.high)}`;
}

function rangeText({ name, range, unit }: AttributeEntry): string {
  if (!range || MASKS.includes(name)) return "";
  const [low, high] = range.map((bound) => (bound === null ? null : numberText(bound)));
  const behind = unit && unit !== "1" ? ` ${unitText(unit)}` : "";
  if (low === null || high === null) return low === null ? (high === null ? "" : t("At most {{high}}{{unit}}", { high, unit: behind })) : t("At least {{low}}{{unit}}", { low, unit: behind });
  return t("From {{low}} to {{high}}{{unit}}", { low, high, unit: behind });
}

/** The value of the attribute of this name, for people. */
export function valueText(value: AttributeValue, name: string): string {
  if (typeof value === "number") return formatOf(name, null).write(value);
  if (Array.isArray(value)) return value.map(numberText).join(", ");
  if (typeof value === "boolean") return value ? t("yes") : t("no");
  return value === "infinity" ? t("never") : value === "" ? t("not known") : wordText(value);
}
