// SPDX-License-Identifier: MIT
import type { Simulation, Statistics } from "../connection/messages";
import { Signal } from "../signal";

/** State of the scene's simulation, as the server reports it. */
export class Playback {
  /** The simulation was started, paused or reset. */
  readonly changed = new Signal<void>();
  /** New statistics have arrived. */
  readonly measured = new Signal<void>();
  simulation: Simulation = { state: "stopped", time: 0, step: 0 };
  statistics: Statistics | null = null;

  get playing(): boolean {
    return this.simulation.state === "playing";
  }

  /** Sets the time and step that the simulation has reached. */
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
