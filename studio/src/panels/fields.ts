// SPDX-License-Identifier: MIT
import { element } from "./element";
import { NOISE, type NumberFormat, PLAIN, readNumber } from "./number_text";
import { wordText } from "./words";
import { serverWord, t, translatedWord } from "../language";

/** A change of a number, as it is typed: "+=0.5", "-=0.1", "*2", "/3", "+0.5". */
export type Change = (value: number) => number;

/** Null where the text tells no change. */
export function readChange(text: string): Change | null {
  const change = /^\s*(\+=|-=|\*=|\/=|\+|\*|\/)\s*(.+)$/.exec(text);
  const by = change ? readNumber(change[2]!) : NaN;
  if (!change || Number.isNaN(by)) return null;
  const sign = change[1]![0];
  return (value) => (sign === "+" ? value + by : sign === "-" ? value - by : sign === "*" ? value * by : value / by);
}

export interface Field<Value> {
  root: HTMLElement;
  /** Shows a value; null where several entities differ. Does nothing while the user types in the field. */
  set(value: Value | null): void;
  /** Shows an error of the typed value; null removes it. */
  setError(reason: string | null): void;
}

/** A vector of a field: null where several entities differ in a component, and, of what was typed, for what stays as it is. */
export type Components = readonly (number | null)[];

interface NumberOptions {
  /** By how much the arrow keys change the number; by 1 % where it is missing. */
  step?: number | undefined;
  format?: NumberFormat;
  /** A word in the box, such as x. */
  mark?: string;
  /** Changes each of several values that differ. */
  each?: ((change: Change) => void) | undefined;
}

/** One number. Enter or leaving the field commits, Escape restores, the arrow keys change by 1 % or by a step. */
export function numberField(label: string, unit: string, commit: (value: number) => void, { step, format = PLAIN, mark, each }: NumberOptions = {}): Field<number> {
  let shown = "";
  let value: number | null = null;
  // What set() showed last, and whether what was typed since then was refused.
  let told: number | null = null;
  let isRefused = false;
  const hasUnit = unit !== "" && unit !== "1";
  const input = element("input", {
    type: "text",
    inputmode: format === PLAIN ? "decimal" : "text",
    class: "number",
    "aria-label": hasUnit ? `${label}, ${unit}` : label,
    autocomplete: "off",
    spellcheck: "false",
    title: `${label}\n${t("Arrow keys: a little more or less, with Shift ten times that\n+0.5, -=0.1, *2: by so much")}`,
  });
  const behind = hasUnit ? element("span", { class: "unit" }, unit) : null;
  const root = element("span", { class: "field" }, mark ? element("span", { class: "mark", "aria-hidden": "true" }, mark) : null, input, behind);

  const setError = (reason: string | null): void => {
    isRefused = reason !== null;
    markError(root, input, reason);
  };
  const take = (): void => {
    if (input.value === shown) return;
    const change = readChange(input.value);
    if (change && value === null && each) {
      setError(null);
      input.value = shown;
      return each(change);
    }
    const typed = change ? (value === null ? NaN : change(value)) : format.read(input.value);
    if (Number.isNaN(typed)) return setError(t("{{expected}}; a change is typed as +=0.5 or *2", { expected: format.expected }));
    setError(null);
    if (typed !== format.read(input.value)) input.value = format.write(typed);
    shown = input.value;
    value = typed;
    commit(typed);
  };
  input.addEventListener("change", take);
  input.addEventListener("keydown", (event) => {
    if (event.key === "Escape") {
      input.value = shown;
      setError(null);
      input.blur();
    } else if (event.key === "Enter") {
      take();
      input.select();
    } else if ((event.key === "ArrowUp" || event.key === "ArrowDown") && value !== null && Number.isFinite(value)) {
      event.preventDefault();
      const by = (step ?? Math.max(Math.abs(value) * 0.01, 1e-4)) * (event.key === "ArrowUp" ? 1 : -1) * (event.shiftKey ? 10 : 1);
      input.value = format.write(value + by);
      take();
    }
  });
  return {
    root,
    setError,
    set(next) {
      if (document.activeElement === input && input.value !== shown) return;
      // What was refused stays with its reason until the value is another one.
      if (isRefused && next === told) return;
      told = value = next;
      const text = next === null ? "" : format.write(next);
      // The refused text has been replaced, so its error is removed.
      if (text !== shown) setError(null);
      shown = text;
      input.value = shown;
      input.placeholder = next === null ? t("differs") : "";
      // Words such as "never" have no unit.
      behind?.classList.toggle("of-word", /^\p{L}/u.test(text));
    },
  };
}

/** Numbers side by side, such as x y z. Commits only the typed one; the others are null. */
export function vectorField(labels: readonly string[], unit: string, commit: (typed: Components) => void, step?: number, each?: (at: number, change: Change) => void): Field<Components> {
  const fields = labels.map((label, at) =>
    numberField(label, "", (typed) => commit(labels.map((_, each) => (each === at ? typed : null))), { step, mark: markOf(label), each: each && ((change) => each(at, change)) }),
  );
  const root = element("span", { class: "field vector" }, ...fields.map((field) => field.root));
  if (unit && unit !== "1") root.append(element("span", { class: "unit" }, unit));
  return {
    root,
    setError: (reason) => fields[0]!.setError(reason),
    set(next) {
      const least = NOISE * Math.max(0, ...(next ?? []).map((part) => Math.abs(part ?? 0)));
      fields.forEach((field, at) => {
        const part = next?.[at] ?? null;
        field.set(part !== null && Math.abs(part) < least ? 0 : part);
      });
    },
  };
}

/** The last word of a label where it is short, such as x or xy; else its first letter. */
function markOf(label: string): string {
  const last = label.slice(label.lastIndexOf(" ") + 1);
  return /^[a-z]{1,2}$/i.test(last) ? last : last[0]!.toLowerCase();
}

/** Yes or no. */
export function truthField(label: string, commit: (value: boolean) => void): Field<boolean> {
  const input = element("input", { type: "checkbox", "aria-label": label });
  input.addEventListener("change", () => commit(input.checked));
  const root = element("span", { class: "field" }, input);
  return {
    root,
    setError: (reason) => markError(root, input, reason),
    set(next) {
      input.indeterminate = next === null;
      input.checked = next === true;
    },
  };
}

/** One of the choices, or any word where there are none. */
export function wordField(label: string, choices: readonly string[], commit: (value: string) => void): Field<string> {
  if (choices.length === 0) return freeWordField(label, commit);
  const select = element("select", { "aria-label": label }, ...choices.map((choice) => element("option", { value: choice }, wordText(choice))));
  select.addEventListener("change", () => commit(select.value));
  const root = element("span", { class: "field" }, select);
  return {
    root,
    setError: (reason) => markError(root, select, reason),
    set(next) {
      if (next !== null && !choices.includes(next)) select.append(element("option", { value: next }, wordText(next)));
      select.value = next ?? "";
    },
  };
}

/** Any word of the server's, such as a category: shown and typed in the user's language. */
function freeWordField(label: string, commit: (value: string) => void): Field<string> {
  const field = textField(label, (typed) => commit(serverWord(typed)), t("not known"));
  return { ...field, set: (next) => field.set(next === null ? null : translatedWord(next)) };
}

/** Any text; `empty` is shown where there is none. */
export function textField(label: string, commit: (value: string) => void, empty = ""): Field<string> {
  const input = element("input", { type: "text", "aria-label": label, autocomplete: "off" });
  let shown = "";
  input.addEventListener("change", () => commit((shown = input.value)));
  input.addEventListener("keydown", (event) => {
    if (event.key === "Escape") input.value = shown;
    if (event.key === "Escape" || event.key === "Enter") input.blur();
  });
  const root = element("span", { class: "field" }, input);
  return {
    root,
    setError: (reason) => markError(root, input, reason),
    set(next) {
      if (document.activeElement === input && input.value !== shown) return;
      shown = next ?? "";
      input.value = shown;
      input.placeholder = next === null ? t("differs") : empty;
    },
  };
}

function markError(root: HTMLElement, input: HTMLElement, reason: string | null): void {
  root.parentElement?.querySelector(":scope > .field-error")?.remove();
  input.toggleAttribute("aria-invalid", reason !== null);
  if (reason !== null) root.after(element("span", { class: "field-error", role: "alert" }, reason));
}
