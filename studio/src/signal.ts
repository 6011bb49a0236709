// SPDX-License-Identifier: MIT

/** An event that listeners subscribe to. */
export class Signal<Value> {
  private readonly listeners = new Set<(value: Value) => void>();

  /** Subscribes `listener`; the returned function unsubscribes it. */
  on(listener: (value: Value) => void): () => void {
    this.listeners.add(listener);
    return () => this.listeners.delete(listener);
  }

  emit(value: Value): void {
    for (const listener of this.listeners) listener(value);
  }
}
