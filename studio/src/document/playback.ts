// SPDX-License-Identifier: MIT
import type { Simulation, Statistics } from "../connection/messages";
import { Signal } from "../signal";

/** What the simulation of the scene does, as the server tells it. */
export class Playback {
  /** It was started, paused or reset. */
  readonly changed = new Signal<void>();
  /** There are new statistics. */
  readonly measured = new Signal<void>();
  simulation: Simulation = { state: "stopped", time: 0, step: 0 };
  statistics: Statistics | null = null;

  get playing(): boolean {
    return this.simulation.state === "playing";
  }

  /** The moment that the simulation has come to. */
  goOn({ time, step }: { time: number; step: number }): void {
    this.simulation.time = time;
    this.simulation.step = step;
  }

  measure(statistics: Statistics): void {
    this.statistics = statistics;
    // While everything sleeps no frames come, but time goes on.
    if (this.playing) this.goOn(statistics);
  }
}
