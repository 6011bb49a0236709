// SPDX-License-Identifier: MIT

/** Tells whoever listens that something happened. */
export class Signal<Value> {
  private readonly listeners = new Set<(value: Value) => void>();

  /** Calls `listener` from now on; the returned function ends that. */
  on(listener: (value: Value) => void): () => void {
    this.listeners.add(listener);
    return () => this.listeners.delete(listener);
  }

  emit(value: Value): void {
    for (const listener of this.listeners) listener(value);
  }
}
