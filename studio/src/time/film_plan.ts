// SPDX-License-Identifier: MIT
/** What is filmed: simulated seconds of the take, as `rate` of them in one of the film's. */
export interface FilmPlan {
  from: number;
  to: number;
  rate: number;
  /** Pictures a second. */
  fps: number;
  width: number;
  height: number;
  /** Turns of the camera about what it looks at, from beginning to end. */
  turns: number;
  /** Written over the lower left; empty: nothing. */
  text: string;
}

/** Number of pictures, the first and the last moment among them. */
export function picturesOf({ from, to, rate, fps }: FilmPlan): number {
  return Math.max(1, Math.floor(((to - from) / rate) * fps + 1e-6) + 1);
}
