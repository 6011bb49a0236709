// SPDX-License-Identifier: MIT
import { Signal } from "../signal";

/** The selected entities, the last selected one last. */
export class Selection {
  readonly changed = new Signal<void>();
  private chosen: number[] = [];

  get indices(): readonly number[] {
    return this.chosen;
  }

  has(index: number): boolean {
    return this.chosen.includes(index);
  }

  set(indices: Iterable<number>): void {
    const next = [...new Set(indices)];
    if (next.length === this.chosen.length && next.every((index, at) => index === this.chosen[at])) return;
    this.chosen = next;
    this.changed.emit();
  }

  toggle(index: number): void {
    this.set(this.has(index) ? this.chosen.filter((other) => other !== index) : [...this.chosen, index]);
  }

  clear(): void {
    this.set([]);
  }
}
