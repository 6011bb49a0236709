// SPDX-License-Identifier: MIT
/** Widths and heights of pictures and films that screens have, pixels. */
export const PICTURE_SIZES: readonly (readonly [number, number])[] = [
  [640, 360],
  [960, 540],
  [1280, 720],
  [1920, 1080],
  [2560, 1440],
  [3840, 2160],
  [1080, 1080],
  [1080, 1920],
];
