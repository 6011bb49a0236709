// SPDX-License-Identifier: MIT
import { Vector3 } from "three";
import { CommandRefused } from "../connection/connection";
import type { Parts } from "../parts";
import type { Grabbing } from "./grabbing";
import type { Hand } from "./hand";

/** Radius of the ball that a hand is while it touches things, m of the room. */
const RADIUS = 0.045;
/** A hand that moved less than this is not told again, m of the room. */
const LEAST_MOVE = 0.002;

/** One empty hand in a running scene: a ball that pushes things, cloth and liquids. */
export class Touch {
  private touches = false;
  private busy = false;
  private unknown = false;
  private readonly told = new Vector3(Infinity, 0, 0);

  constructor(
    private readonly parts: Pick<Parts, "server" | "playback">,
    private readonly hand: Hand,
    private readonly grabbing: Grabbing,
  ) {}

  update(scale: number): void {
    if (this.unknown || this.busy) return;
    const { hand } = this;
    const wanted = this.parts.playback.playing && hand.seen && this.grabbing.held(hand.side) === null;
    if (wanted && this.told.distanceTo(hand.position) > LEAST_MOVE * scale) {
      this.touches = true;
      this.told.copy(hand.position);
      void this.send({ position: hand.position.toArray() as [number, number, number], rotation: hand.rotation.toArray() as [number, number, number, number], radius: RADIUS * scale });
    } else if (!wanted && this.touches) this.end();
  }

  end(): void {
    if (!this.touches) return;
    this.touches = false;
    this.told.x = Infinity;
    void this.send({});
  }

  private async send(where: { position?: [number, number, number]; rotation?: [number, number, number, number]; radius?: number }): Promise<void> {
    this.busy = true;
    try {
      await this.parts.server.request("simulation.touch", { hand: this.hand.side, ...where });
    } catch (error) {
      // A run that ended meanwhile has no hands; a server without the command is not asked again.
      this.unknown = error instanceof CommandRefused && /is not a command/.test(error.error.why);
    }
    this.busy = false;
  }
}
