// SPDX-License-Identifier: MIT
// Actions as sentences: “When K is pressed, then give Ball a push of 5 N s.”
import type { Action, Effect, Target, Trigger, Vector } from "../connection/scene_types";
import { numberText } from "./number_text";
import { wordText } from "./words";
import { t, translateServerText } from "../language";

export type Namer = (index: number) => string;

/** Who is meant; `any` is the word for everybody. */
export function targetText(target: Target | undefined, called: Namer, any: string): string {
  if (target === undefined || target === "any") return any;
  if ("index" in target) return called(target.index);
  return "name" in target ? `“${target.name}”` : t("any {{category}}", { category: translateServerText(target.category) });
}

function sizeText(vector: Vector, unit: string): string {
  return `${numberText(Number(Math.hypot(...vector).toPrecision(3)))} ${unit}`;
}

export function whenText(trigger: Trigger, sender: Target | undefined, called: Namer): string {
  const who = targetText(sender, called, t("anything"));
  switch (trigger.type) {
    case "signal":
      return trigger.key ? t("{{key}} is pressed", { key: trigger.key }) : t("the button “{{button}}” is pressed", { button: trigger.button ?? "" });
    case "time":
      return trigger.repeat_every
        ? t("{{time}} s have passed, and every {{every}} s after that", { time: numberText(trigger.time ?? 0), every: numberText(trigger.repeat_every) })
        : t("{{time}} s have passed", { time: numberText(trigger.time ?? 0) });
    case "contact_begin":
      return trigger.least_approach_speed
        ? t("{{who}} touches {{other}} with {{speed}} m/s or more", { who, other: targetText(trigger.other, called, t("anything")), speed: numberText(trigger.least_approach_speed) })
        : t("{{who}} touches {{other}}", { who, other: targetText(trigger.other, called, t("anything")) });
    case "contact_end":
      return t("{{who}} no longer touches {{other}}", { who, other: targetText(trigger.other, called, t("anything")) });
    case "enter_volume":
      return t("{{who}} comes into the box at {{place}}", { who, place: trigger.lower.map((lower, axis) => numberText(Number(((lower + trigger.upper[axis]!) / 2).toPrecision(3)))).join(", ") });
    case "fall_asleep":
      return t("{{who}} comes to rest", { who });
  }
}

export function thenText(effect: Effect, receiver: Target | undefined, isCaused: boolean, called: Namer): string {
  const whom = targetText(receiver, called, isCaused ? t("it") : t("everything"));
  switch (effect.type) {
    case "apply_impulse":
      return t("give {{whom}} a push of {{impulse}}", { whom, impulse: sizeText(effect.impulse, "N s") });
    case "apply_force":
      return effect.duration
        ? t("push {{whom}} with {{force}} for {{duration}} s", { whom, force: sizeText(effect.force, "N"), duration: numberText(effect.duration) })
        : t("push {{whom}} with {{force}} once", { whom, force: sizeText(effect.force, "N") });
    case "set_velocity":
      return t("let {{whom}} move with {{speed}}", { whom, speed: sizeText(effect.linear ?? [0, 0, 0], "m/s") });
    case "set_attribute":
      return t("set {{name}} of {{whom}} to {{value}}", { name: wordText(effect.name), whom, value: typeof effect.value === "number" ? numberText(effect.value) : wordText(String(effect.value)) });
    case "spawn":
      return t("add a copy of {{whom}}", { whom });
    case "remove":
      return t("remove {{whom}}", { whom });
    case "set_enabled":
      return effect.enabled === false ? t("switch {{whom}} off", { whom }) : t("switch {{whom}} on", { whom });
    case "set_open":
      return effect.open === false ? t("shut tap and drain of {{whom}}", { whom }) : t("open tap and drain of {{whom}}", { whom });
    case "melt":
      return effect.into ? t("melt {{whom}} into {{liquid}}", { whom, liquid: called(effect.into) }) : t("melt {{whom}}", { whom });
    case "freeze":
      return t("freeze {{whom}}", { whom });
    case "pause":
      return t("pause the simulation");
  }
}

/** Whether somebody's doing sets it off, who may then be changed. */
export function isCaused({ type }: Pick<Trigger, "type">): boolean {
  return type !== "time" && type !== "signal";
}

export function actionText({ trigger, sender, effect, receiver }: Omit<Action, "id">, called: Namer): string {
  return t("When {{trigger}}, then {{effect}}.", { trigger: whenText(trigger, sender, called), effect: thenText(effect, receiver, isCaused(trigger), called) });
}
