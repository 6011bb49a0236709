// SPDX-License-Identifier: MIT
import type { TakeState, TimeMark } from "../connection/messages";
import { Signal } from "../signal";

/** What is recorded of the run, as the server tells it. */
export class Take {
  /** Its length, what is shown of it, or its marks have changed. */
  readonly changed = new Signal<void>();
  /** Other marks are there: whoever shows them asks for them. */
  readonly marked = new Signal<void>();
  state: TakeState = { start: 0, end: 0, shown: null, bytes: 0, samples: 0, marks: 0 };
  marks: readonly TimeMark[] = [];

  /** Whether anything has run. */
  get isThere(): boolean {
    return this.state.samples > 1;
  }

  take({ start, end, shown, bytes, samples, marks }: TakeState): void {
    const isMarked = marks !== this.state.marks;
    this.state = { start, end, shown, bytes, samples, marks };
    this.changed.emit();
    if (isMarked) this.marked.emit();
  }

  setMarks(marks: readonly TimeMark[]): void {
    this.marks = marks;
    this.changed.emit();
  }
}
