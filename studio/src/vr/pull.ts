// SPDX-License-Identifier: MIT
import { Quaternion, Vector3 } from "three";
import type { Parts } from "../parts";
import type { Side } from "./hand";

type Four = [number, number, number, number];

/** One hand's hold on a body while the scene plays: the server's spring pulls it; the newest target is sent as fast as it answers. */
export class Pull {
  readonly target = new Vector3();
  readonly rotation = new Quaternion();
  private readonly sent = new Vector3();
  private readonly sentRotation = new Quaternion();
  private isBusy = true;
  private isOver = false;
  private work: Promise<void>;

  constructor(
    private readonly parts: Pick<Parts, "server">,
    private readonly side: Side,
    hold: { index: number; point: Vector3; rotation: Quaternion; strength: number },
  ) {
    this.target.copy(hold.point);
    this.sent.copy(hold.point);
    this.rotation.copy(hold.rotation);
    this.sentRotation.copy(hold.rotation);
    this.work = this.begin(hold.index, hold.strength);
  }

  /** Call when target or rotation has changed. */
  follow(): void {
    if (!this.isBusy && !this.isOver) this.work = this.sendNewest();
  }

  /** Lets go, once the server has the last target: the body flies on with the velocity that the hand gave it. */
  async release(): Promise<void> {
    await this.work;
    if (this.isOver) return;
    this.isOver = true;
    // In a run that was reset meanwhile nothing is held any more.
    await this.parts.server.request("simulation.release", { hand: this.side }).catch(() => {});
  }

  private async begin(index: number, strength: number): Promise<void> {
    const target = this.sent.toArray();
    const rotation = this.sentRotation.toArray() as Four;
    const held = await this.parts.server.command("simulation.grab", { index, point: target, target, hand: this.side, rotation, strength });
    this.isOver = !held;
    await this.sendNewest();
  }

  private async sendNewest(): Promise<void> {
    this.isBusy = true;
    while (!this.isOver && !(this.sent.equals(this.target) && this.sentRotation.equals(this.rotation))) {
      this.sent.copy(this.target);
      this.sentRotation.copy(this.rotation);
      try {
        await this.parts.server.request("simulation.move_grab", { target: this.sent.toArray(), rotation: this.sentRotation.toArray() as Four, hand: this.side });
      } catch {
        // The run was reset, or the body is gone: there is nothing to hold any more.
        this.isOver = true;
      }
    }
    this.isBusy = false;
  }
}
