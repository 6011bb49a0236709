// SPDX-License-Identifier: MIT
// Actions as sentences: “When K is pressed, then give Ball a push of 5 N s.”
import type { Action, Effect, Target, Trigger, Vector } from "../connection/scene_types";
import { numberText } from "./number_text";

export type Namer = (index: number) => string;

/** Who is meant; `any` is the word for everybody. */
export function targetText(target: Target | undefined, called: Namer, any: string): string {
  if (target === undefined || target === "any") return any;
  if ("index" in target) return called(target.index);
  return "name" in target ? `“${target.name}”` : `any ${target.category}`;
}

function sizeText(vector: Vector, unit: string): string {
  return `${numberText(Number(Math.hypot(...vector).toPrecision(3)))} ${unit}`;
}

export function whenText(trigger: Trigger, sender: Target | undefined, called: Namer): string {
  const who = targetText(sender, called, "anything");
  switch (trigger.type) {
    case "signal":
      return trigger.key ? `${trigger.key} is pressed` : `the button “${trigger.button ?? ""}” is pressed`;
    case "time":
      return `${numberText(trigger.time ?? 0)} s have passed${trigger.repeat_every ? `, and every ${numberText(trigger.repeat_every)} s after that` : ""}`;
    case "contact_begin":
      return `${who} touches ${targetText(trigger.other, called, "anything")}${trigger.least_approach_speed ? ` with ${numberText(trigger.least_approach_speed)} m/s or more` : ""}`;
    case "contact_end":
      return `${who} no longer touches ${targetText(trigger.other, called, "anything")}`;
    case "enter_volume":
      return `${who} comes into the box at ${trigger.lower.map((lower, axis) => numberText(Number(((lower + trigger.upper[axis]!) / 2).toPrecision(3)))).join(", ")}`;
    case "fall_asleep":
      return `${who} comes to rest`;
  }
}

export function thenText(effect: Effect, receiver: Target | undefined, isCaused: boolean, called: Namer): string {
  const whom = targetText(receiver, called, isCaused ? "it" : "everything");
  switch (effect.type) {
    case "apply_impulse":
      return `give ${whom} a push of ${sizeText(effect.impulse, "N s")}`;
    case "apply_force":
      return `push ${whom} with ${sizeText(effect.force, "N")}${effect.duration ? ` for ${numberText(effect.duration)} s` : " once"}`;
    case "set_velocity":
      return `let ${whom} move with ${sizeText(effect.linear ?? [0, 0, 0], "m/s")}`;
    case "set_attribute":
      return `set ${effect.name.replaceAll("_", " ")} of ${whom} to ${typeof effect.value === "number" ? numberText(effect.value) : String(effect.value).replaceAll("_", " ")}`;
    case "spawn":
      return `add a copy of ${whom}`;
    case "remove":
      return `remove ${whom}`;
    case "set_enabled":
      return effect.enabled === false ? `switch ${whom} off` : `switch ${whom} on`;
    case "pause":
      return "pause the simulation";
  }
}

/** Whether somebody's doing sets it off, who may then be changed. */
export function isCaused({ type }: Pick<Trigger, "type">): boolean {
  return type !== "time" && type !== "signal";
}

export function actionText({ trigger, sender, effect, receiver }: Omit<Action, "id">, called: Namer): string {
  return `When ${whenText(trigger, sender, called)}, then ${thenText(effect, receiver, isCaused(trigger), called)}.`;
}
