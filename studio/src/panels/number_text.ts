// SPDX-License-Identifier: MIT
import { t } from "../language";
// How numbers are written in the panels, and read again: whatever is shown can be typed.

/** Beside numbers of size one, smaller values are rounding errors and shown as 0. */
export const NOISE = 1e-6;
/** Number of collision groups, each a bit of a mask. */
const GROUPS = 32;
const ALL_GROUPS = 2 ** GROUPS - 1;
const SUPERSCRIPTS = "⁰¹²³⁴⁵⁶⁷⁸⁹";

/** What stands before groups that are left out, in English and in the user's language. */
const BUT = ["all but", "all except", t("all but {{groups}}", { groups: "" }).trim()];

/** Writes and reads the numbers of a field. `read` gives NaN for what it does not understand. */
export interface NumberFormat {
  write(value: number): string;
  read(text: string): number;
  /** What can be typed, for the message beside a field that did not understand. */
  expected: string;
}

/** A number for people: five significant digits, without rounding errors; whole numbers in full. */
export function numberText(value: number): string {
  if (!Number.isFinite(value)) return value > 0 ? "∞" : value < 0 ? "-∞" : "?";
  if (value === 0) return "0";
  const size = Math.abs(value);
  if (Number.isInteger(value) && size < 1e10) return String(value);
  if (size < 1e-4 || size >= 1e6) return withPower(value);
  return String(Number(value.toPrecision(5)));
}

/** For example 2.1×10¹¹. */
function withPower(value: number): string {
  const [digits, power] = value.toExponential(3).split("e") as [string, string];
  const raised = [...power.replace("+", "")].map((sign) => (sign === "-" ? "⁻" : SUPERSCRIPTS[Number(sign)])).join("");
  return `${Number(digits)}×10${raised}`;
}

/** Reads a typed number; a comma counts as the decimal point. NaN where the text is no number. */
export function readNumber(text: string): number {
  const lowered = [...text.trim()].map((sign) => (sign === "⁻" ? "-" : SUPERSCRIPTS.includes(sign) ? String(SUPERSCRIPTS.indexOf(sign)) : sign)).join("");
  const plain = lowered.replace(/\s*[×*·]\s*10\^?(?=[-+]?\d+$)/, "e").replace(",", ".").replace("−", "-").replace("∞", "Infinity");
  return plain === "" ? NaN : Number(plain);
}

export const PLAIN: NumberFormat = { write: numberText, read: readNumber, expected: t("This is not a number") };

/** A threshold: an infinite one is reached never. */
export const THRESHOLD: NumberFormat = {
  write: (value) => (value === Infinity ? t("never") : numberText(value)),
  read: (text) => (text.trim() === t("never") || /^(never|none|inf|infinity)$/i.test(text.trim()) ? Infinity : readNumber(text)),
  expected: t("Type a number, or never"),
};

/** Collision groups, 1 … 32, as the bits of a mask: "all", "none", "1, 3" or "all but 2". */
export const GROUP_LIST: NumberFormat = {
  write(mask) {
    if (mask === ALL_GROUPS) return t("all");
    if (mask === 0) return t("none");
    const has = (group: number) => Math.floor(mask / 2 ** (group - 1)) % 2 === 1;
    const groups = Array.from({ length: GROUPS }, (_, at) => at + 1);
    const without = groups.filter((group) => !has(group));
    return without.length < GROUPS / 2 ? t("all but {{groups}}", { groups: without.join(", ") }) : groups.filter(has).join(", ");
  },
  read(text) {
    const words = text.trim().toLowerCase();
    if (words === "all" || words === t("all")) return ALL_GROUPS;
    if (words === "none" || words === t("none")) return 0;
    const but = BUT.find((each) => words.startsWith(each));
    const list = words.slice(but?.length ?? 0);
    const groups = new Set(list.split(/[\s,;]+/).filter(Boolean).map(Number));
    if (groups.size === 0 || [...groups].some((group) => !Number.isInteger(group) || group < 1 || group > GROUPS)) return NaN;
    const mask = [...groups].reduce((sum, group) => sum + 2 ** (group - 1), 0);
    return but ? ALL_GROUPS - mask : mask;
  },
  expected: t("Type groups from 1 to 32, such as 1, 3; or all, none, all but 2"),
};
