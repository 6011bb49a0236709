// SPDX-License-Identifier: MIT

const LONGEST_MS = 120;
/** Of the time between two steps in slow motion, so that a late frame leaves no pause. */
const RESERVE = 1.2;
const LONGEST_STEP_S = 1 / 60;

/** Longest time in which poses and points move to those of a frame, ms: in slow motion frames are further apart. */
export const blend = { longest: LONGEST_MS };

/** `rate`: simulated seconds in one of the clock's. */
export function setBlendRate(rate: number): void {
  blend.longest = Math.max(LONGEST_MS, (RESERVE * 1000 * LONGEST_STEP_S) / rate);
}
