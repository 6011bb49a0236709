// SPDX-License-Identifier: MIT
import { Vector3 } from "three";
import { coarseIndexOf, type Drawable } from "./drawable";

/** Side of a footprint's picture, pixels. */
export const FOOTPRINT_SIDE = 64;
/** What is this high over the base darkens the ground by 1/e of what touches it, m. */
const REACH = 0.22;
/** The picture is larger than the thing by this on each side, as a share of the thing, and m. */
const MARGIN_SHARE = 0.12;
const MARGIN = 0.02;
/** Surfaces nearer than this to the full one do, as a share of the thing's size. */
const ENOUGH = 0.01;
const BLUR = 2;

/** How much a thing darkens what it stands on, seen from above, in its own frame. */
export interface Footprint {
  /** Corner of the picture with the least x and z, and its size, m. */
  left: number;
  back: number;
  width: number;
  depth: number;
  /** FOOTPRINT_SIDE² values, 0 … 255, row by row along x. */
  pixels: Uint8Array;
}

const a = new Vector3();
const b = new Vector3();
const c = new Vector3();

/** Drawn from the thing's triangles: what is low counts most. */
export function footprintOf(drawable: Drawable): Footprint {
  const { min, max } = drawable.bounds;
  const marginX = MARGIN + MARGIN_SHARE * (max.x - min.x);
  const marginZ = MARGIN + MARGIN_SHARE * (max.z - min.z);
  const frame = { left: min.x - marginX, back: min.z - marginZ, width: max.x - min.x + 2 * marginX, depth: max.z - min.z + 2 * marginZ };
  const side = FOOTPRINT_SIDE;
  const dark = new Float32Array(side * side);
  const toColumn = side / frame.width;
  const toRow = side / frame.depth;
  const size = max.distanceTo(min);
  for (const part of drawable.parts) {
    if (part.material.transparent) continue;
    const position = part.geometry.getAttribute("position");
    const index = coarseIndexOf(drawable, part, ENOUGH * size);
    const count = index?.count ?? position.count;
    for (let at = 0; at + 2 < count; at += 3) {
      [a, b, c].forEach((corner, k) => {
        corner.fromBufferAttribute(position, index?.getX(at + k) ?? at + k).applyMatrix4(part.matrix);
        corner.set((corner.x - frame.left) * toColumn, corner.y - min.y, (corner.z - frame.back) * toRow);
      });
      fill(dark);
    }
  }
  return { ...frame, pixels: finished(dark) };
}

/** Darkens the cells below the triangle a b c, whose x and z are columns and rows. */
function fill(dark: Float32Array): void {
  const side = FOOTPRINT_SIDE;
  const area = (b.x - a.x) * (c.z - a.z) - (c.x - a.x) * (b.z - a.z);
  for (const corner of [a, b, c]) darken(dark, Math.floor(corner.x), Math.floor(corner.z), corner.y);
  if (Math.abs(area) < 1e-6) return;
  const [left, right] = [Math.max(0, Math.floor(Math.min(a.x, b.x, c.x))), Math.min(side - 1, Math.floor(Math.max(a.x, b.x, c.x)))];
  const [back, front] = [Math.max(0, Math.floor(Math.min(a.z, b.z, c.z))), Math.min(side - 1, Math.floor(Math.max(a.z, b.z, c.z)))];
  for (let row = back; row <= front; ++row)
    for (let column = left; column <= right; ++column) {
      const x = column + 0.5 - a.x;
      const z = row + 0.5 - a.z;
      const toB = (x * (c.z - a.z) - z * (c.x - a.x)) / area;
      const toC = (z * (b.x - a.x) - x * (b.z - a.z)) / area;
      if (toB >= 0 && toC >= 0 && toB + toC <= 1) darken(dark, column, row, a.y + toB * (b.y - a.y) + toC * (c.y - a.y));
    }
}

function darken(dark: Float32Array, column: number, row: number, height: number): void {
  const at = FOOTPRINT_SIDE * row + column;
  dark[at] = Math.max(dark[at]!, Math.exp(-Math.max(0, height) / REACH));
}

/** Blurred, and clear at the edges. */
function finished(dark: Float32Array): Uint8Array {
  const side = FOOTPRINT_SIDE;
  let blurred = dark;
  for (const step of [1, side, 1, side]) blurred = blur(blurred, step);
  const pixels = new Uint8Array(side * side);
  for (let row = 1; row + 1 < side; ++row) for (let column = 1; column + 1 < side; ++column) pixels[side * row + column] = Math.round(255 * Math.min(1, blurred[side * row + column]!));
  return pixels;
}

/** The mean over BLUR cells to both sides along a row (step 1) or a column. */
function blur(from: Float32Array, step: number): Float32Array {
  const side = FOOTPRINT_SIDE;
  const to = new Float32Array(from.length);
  const across = step === 1 ? side : 1;
  for (let line = 0; line < side; ++line)
    for (let cell = 0; cell < side; ++cell) {
      let sum = 0;
      for (let k = -BLUR; k <= BLUR; ++k) if (cell + k >= 0 && cell + k < side) sum += from[line * across + (cell + k) * step]!;
      to[line * across + cell * step] = sum / (2 * BLUR + 1);
    }
  return to;
}
