// SPDX-License-Identifier: MIT
// What the hands do in a headset, for the help on the page and in the room.

export type Control = readonly [gesture: string, what: string];

export const CONTROLS: readonly Control[] = [
  ["Trigger or squeeze at a thing", "take it, carry it; in a run, throw it"],
  ["Trigger with the ray", "take far things, press buttons"],
  ["Stick while the ray holds", "nearer, farther, turn"],
  ["Second hand on the thing", "turn it, make it larger or smaller"],
  ["Stick forward, let go", "go there"],
  ["Right stick aside", "turn yourself"],
  ["Both squeezes on nothing", "move, turn and scale the world"],
  ["X, or look at the left wrist", "menu"],
  ["Y, A, B", "models, details, undo"],
];

/** The same with tracked hands: a pinch is the trigger, a fist the squeeze. */
export const HAND_CONTROLS: readonly Control[] = [
  ["Pinch", "take, press; at the floor: go there"],
  ["Both fists", "move, turn and scale the world"],
  ["Back of the left hand to the eyes", "menu"],
];
