// SPDX-License-Identifier: MIT

/** How this user moves and holds things in a headset; kept with the preferences. */
export interface VrSettings {
  /** The left stick walks, or aims a teleport as the right one does. */
  walk: boolean;
  /** The stick turns by steps of `turnAngle`, or smoothly. */
  turn: "snap" | "smooth";
  /** Degrees. */
  turnAngle: 30 | 45;
  /** The edge of the picture is darkened while walking and turning smoothly: 0 (off) … 1. */
  vignette: number;
  /** Added to the height of the head: for whoever sits, m. */
  heightOffset: number;
  /** Walking stops at walls. */
  walls: boolean;
  /** The scene at 1:10 on a table, or life-size. */
  dollhouse: boolean;
  /** Greatest force of a hand, N. */
  strength: number;
  haptics: boolean;
  /** Part of the device's own resolution. */
  sharpness: number;
  /** How much coarser the edge of the picture is drawn: 0 … 1. */
  foveation: number;
}

export const VR_DEFAULTS: VrSettings = {
  walk: false,
  turn: "snap",
  turnAngle: 30,
  vignette: 0.6,
  heightOffset: 0,
  walls: true,
  dollhouse: false,
  // The default of the protocol: what a person lifts with one arm.
  strength: 400,
  haptics: true,
  sharpness: 1,
  foveation: 0.5,
};
