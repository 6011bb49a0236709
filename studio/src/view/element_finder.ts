// SPDX-License-Identifier: MIT
import { Box3, Vector3 } from "three";
import type { SoftForm } from "./soft_form";

/** Finds the element that contains a point, or the nearest one. */
export class ElementFinder {
  private readonly cells = new Map<number, number[]>();
  private readonly box = new Box3();
  private readonly size: [number, number, number];
  private readonly own = new Float32Array(4);
  private readonly best = new Float32Array(4);

  constructor(private readonly form: SoftForm) {
    this.box.setFromArray(form.nodes);
    const extent = this.box.getSize(new Vector3());
    this.size = [0, 1, 2].map((axis) => Math.floor(extent.getComponent(axis) / form.edge) + 1) as [number, number, number];
    const around = new Box3();
    const corner = new Vector3();
    for (let t = 0; t < form.count; ++t) {
      around.makeEmpty();
      for (let k = 0; k < form.corners; ++k) around.expandByPoint(corner.fromArray(form.nodes, 3 * form.elements[form.corners * t + k]!));
      const low = this.cellOf(around.min.x, around.min.y, around.min.z);
      const high = this.cellOf(around.max.x, around.max.y, around.max.z);
      this.visit(low, high, (cell) => {
        const list = this.cells.get(cell);
        if (list) list.push(t);
        else this.cells.set(cell, [t]);
      });
    }
  }

  /** The element, and the weights of its nodes at its point that is nearest; none is negative. Without those that `isLeftOut` names. */
  find(x: number, y: number, z: number, weights: Float32Array, isLeftOut?: (t: number) => boolean): number {
    const middle = this.cellOf(x, y, z);
    let found = -1;
    let least = Infinity;
    const farthest = Math.max(...this.size);
    for (let ring = 0; ring <= farthest && !(ring > 0 && least <= ((ring - 1) * this.form.edge) ** 2); ++ring) {
      const low = middle.map((c) => Math.max(0, c - ring));
      const high = middle.map((c, axis) => Math.min(this.size[axis]! - 1, c + ring));
      this.visit(low, high, (cell, i, j, k) => {
        if (Math.max(Math.abs(i - middle[0]!), Math.abs(j - middle[1]!), Math.abs(k - middle[2]!)) !== ring) return;
        for (const t of this.cells.get(cell) ?? []) {
          const distance = this.squareTo(t, x, y, z);
          if (distance >= least || isLeftOut?.(t)) continue;
          least = distance;
          found = t;
          this.best.set(this.own);
        }
      });
    }
    weights.set(this.best);
    return found;
  }

  /** The weights that `find` gives where it finds this element. */
  weigh(t: number, x: number, y: number, z: number, weights: Float32Array): void {
    this.squareTo(t, x, y, z);
    weights.set(this.own);
  }

  /** Square of the distance to the point with the weights clamped to zero: 0 inside a solid. Leaves these in `own`. */
  private squareTo(t: number, x: number, y: number, z: number): number {
    const { nodes, elements, corners } = this.form;
    this.form.weightsAt(t, x, y, z, this.own);
    let sum = 0;
    let isInside = corners === 4;
    for (let k = 0; k < corners; ++k) {
      isInside &&= this.own[k]! >= 0;
      sum += this.own[k] = Math.max(0, this.own[k]!);
    }
    if (isInside) return 0;
    let dx = x, dy = y, dz = z;
    for (let k = 0; k < corners; ++k) {
      const at = 3 * elements[corners * t + k]!;
      const weight = (this.own[k]! /= sum);
      dx -= weight * nodes[at]!;
      dy -= weight * nodes[at + 1]!;
      dz -= weight * nodes[at + 2]!;
    }
    return dx * dx + dy * dy + dz * dz;
  }

  private cellOf(x: number, y: number, z: number): number[] {
    return [x, y, z].map((value, axis) => {
      const cell = Math.floor((value - this.box.min.getComponent(axis)) / this.form.edge);
      return Math.min(Math.max(cell, 0), this.size[axis]! - 1);
    });
  }

  private visit(low: number[], high: number[], each: (cell: number, i: number, j: number, k: number) => void): void {
    for (let i = low[0]!; i <= high[0]!; ++i)
      for (let j = low[1]!; j <= high[1]!; ++j)
        for (let k = low[2]!; k <= high[2]!; ++k) each((i * this.size[1] + j) * this.size[2] + k, i, j, k);
  }
}
