// SPDX-License-Identifier: MIT
import type { ModelSummary } from "../connection/messages";
import { Signal } from "../signal";

/** The model of the catalogue whose properties are shown; there is none while an entity is selected. */
export class PickedModel {
  readonly changed = new Signal<void>();
  private picked: ModelSummary | null = null;

  get model(): ModelSummary | null {
    return this.picked;
  }

  set(model: ModelSummary | null): void {
    if (model === this.picked) return;
    this.picked = model;
    this.changed.emit();
  }
}
