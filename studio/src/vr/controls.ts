// SPDX-License-Identifier: MIT
import { t } from "../language";
// What the hands do in a headset, for the help on the page and in the room.

export type Control = readonly [gesture: string, what: string];

export const CONTROLS: readonly Control[] = [
  [t("Trigger or squeeze at a thing"), t("take it, carry it; in a run, throw it")],
  [t("Trigger with the ray"), t("take far things, press buttons")],
  [t("Stick while the ray holds"), t("nearer, farther, turn")],
  [t("Second hand on the thing"), t("turn it, make it larger or smaller")],
  [t("Stick forward, let go"), t("go there")],
  [t("Right stick aside"), t("turn yourself")],
  [t("Both squeezes on nothing"), t("move, turn and scale the world")],
  [t("X, or look at the left wrist"), t("menu")],
  ["Y, A, B", t("models, details, undo")],
];

/** The same with tracked hands: a pinch is the trigger, a fist the squeeze. */
export const HAND_CONTROLS: readonly Control[] = [
  [t("Pinch"), t("take, press; at the floor: go there")],
  [t("Both fists"), t("move, turn and scale the world")],
  [t("Back of the left hand to the eyes"), t("menu")],
];
