// SPDX-License-Identifier: MIT
import { element } from "./element";

/** Beside numbers of size one, smaller values are rounding errors and shown as 0. */
export const NOISE = 1e-6;

/** A number for people: five significant digits, without rounding errors; whole numbers in full. */
export function numberText(value: number): string {
  if (!Number.isFinite(value)) return value > 0 ? "∞" : value < 0 ? "-∞" : "?";
  if (value === 0) return "0";
  const size = Math.abs(value);
  if (Number.isInteger(value) && size < 1e10) return String(value);
  if (size < 1e-4 || size >= 1e6) return value.toExponential(3).replace(/\.?0+e/, "e").replace("e+", "e");
  return String(Number(value.toPrecision(5)));
}

/** Reads a typed number; a comma counts as the decimal point. NaN where the text is no number. */
export function readNumber(text: string): number {
  const plain = text.trim().replace(",", ".").replace("∞", "Infinity");
  return plain === "" ? NaN : Number(plain);
}

export interface Field<Value> {
  root: HTMLElement;
  /** Shows a value; null where several entities differ. Does nothing while the user types in the field. */
  set(value: Value | null): void;
  /** Shows an error of the typed value; null removes it. */
  setError(reason: string | null): void;
}

/** One number. Enter or leaving the field commits, Escape restores, the arrow keys change by 1 % or by `step`. */
export function numberField(label: string, unit: string, commit: (value: number) => void, step?: number): Field<number> {
  let shown = "";
  let value: number | null = null;
  const input = element("input", {
    type: "text",
    inputmode: "decimal",
    class: "number",
    "aria-label": unit && unit !== "1" ? `${label}, ${unit}` : label,
    autocomplete: "off",
    spellcheck: "false",
    title: `${label}\nArrow keys: a little more or less, with Shift ten times that`,
  });
  const root = element("span", { class: "field" }, input, unit && unit !== "1" ? element("span", { class: "unit" }, unit) : null);

  const setError = (reason: string | null): void => markError(root, input, reason);
  const take = (): void => {
    if (input.value === shown) return;
    const typed = readNumber(input.value);
    if (Number.isNaN(typed)) return setError("This is not a number");
    setError(null);
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
    } else if ((event.key === "ArrowUp" || event.key === "ArrowDown") && value !== null) {
      event.preventDefault();
      const by = (step ?? Math.max(Math.abs(value) * 0.01, 1e-4)) * (event.key === "ArrowUp" ? 1 : -1) * (event.shiftKey ? 10 : 1);
      input.value = numberText(value + by);
      take();
    }
  });
  return {
    root,
    setError,
    set(next) {
      if (document.activeElement === input && input.value !== shown) return;
      value = next;
      const text = next === null ? "" : numberText(next);
      // The refused text has been replaced, so its error is removed.
      if (text !== shown) setError(null);
      shown = text;
      input.value = shown;
      input.placeholder = next === null ? "differs" : "";
    },
  };
}

/** Numbers side by side, such as x y z. */
export function vectorField(labels: readonly string[], unit: string, commit: (value: number[]) => void, step?: number): Field<readonly number[]> {
  let value: number[] | null = null;
  const fields = labels.map((label, at) =>
    numberField(label, "", (typed) => {
      const next = [...(value ?? labels.map(() => 0))];
      next[at] = typed;
      value = next;
      commit(next);
    }, step),
  );
  const root = element("span", { class: "field vector" }, ...fields.map((field) => field.root));
  if (unit && unit !== "1") root.append(element("span", { class: "unit" }, unit));
  return {
    root,
    setError: (reason) => fields[0]!.setError(reason),
    set(next) {
      value = next === null ? null : [...next];
      const least = NOISE * Math.max(0, ...(next ?? []).map(Math.abs));
      fields.forEach((field, at) => field.set(next === null ? null : Math.abs(next[at] ?? 0) < least ? 0 : next[at]!));
    },
  };
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
  if (choices.length === 0) return textField(label, commit);
  const select = element("select", { "aria-label": label }, ...choices.map((choice) => element("option", { value: choice }, choice.replaceAll("_", " "))));
  select.addEventListener("change", () => commit(select.value));
  const root = element("span", { class: "field" }, select);
  return {
    root,
    setError: (reason) => markError(root, select, reason),
    set(next) {
      if (next !== null && !choices.includes(next)) select.append(element("option", { value: next }, next));
      select.value = next ?? "";
    },
  };
}

export function textField(label: string, commit: (value: string) => void): Field<string> {
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
      input.placeholder = next === null ? "differs" : "";
    },
  };
}

function markError(root: HTMLElement, input: HTMLElement, reason: string | null): void {
  root.parentElement?.querySelector(":scope > .field-error")?.remove();
  input.toggleAttribute("aria-invalid", reason !== null);
  if (reason !== null) root.after(element("span", { class: "field-error", role: "alert" }, reason));
}
