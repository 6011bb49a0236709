// SPDX-License-Identifier: MIT
import { Quaternion, Vector3 } from "three";
import type { Parts } from "../parts";

/** So many places are sent at most before the server has answered: more would only wait on the way. */
const MOST_UNANSWERED = 8;

/** One hand's, or the pointer's, hold on a body while the scene plays: the server's spring pulls it after the places that it is told. */
export class Pull {
  readonly target = new Vector3();
  readonly rotation = new Quaternion();
  private readonly sent = new Vector3();
  private readonly sentRotation = new Quaternion();
  private unanswered = 0;
  private isOver = false;

  /** `hand` as the protocol names it; without `rotation` the body hangs from the point. */
  constructor(
    private readonly parts: Pick<Parts, "server">,
    private readonly hold: { index: number; point: Vector3; rotation?: Quaternion; hand: string; strength: number },
  ) {
    this.target.copy(hold.point);
    if (hold.rotation) this.rotation.copy(hold.rotation);
    void this.begin();
  }

  /** Call in every picture in which target or rotation has changed: the server measures the hand's speed by them. */
  follow(): void {
    if (this.isNewer && !this.isOver && this.unanswered < MOST_UNANSWERED) this.send();
  }

  /** Lets go where the hand is now: the body flies on with the velocity that the hand gave it. */
  release(): void {
    if (this.isOver) return;
    // A place that is told again would say that the hand has stopped.
    if (this.isNewer) this.send();
    this.isOver = true;
    // The server takes commands in their order. In a run that was reset meanwhile nothing is held any more.
    void this.parts.server.request("simulation.release", { hand: this.hold.hand }).catch(() => {});
  }

  private async begin(): Promise<void> {
    const { index, point, hand, strength } = this.hold;
    const place = this.place();
    const held = await this.parts.server.command("simulation.grab", { index, point: point.toArray(), hand, strength, ...place });
    if (!held) this.isOver = true;
  }

  private get isNewer(): boolean {
    return !this.sent.equals(this.target) || !this.sentRotation.equals(this.rotation);
  }

  /** The place that is now the newest, as it is sent. */
  private place(): { target: [number, number, number]; rotation?: [number, number, number, number] } {
    this.sent.copy(this.target);
    this.sentRotation.copy(this.rotation);
    const target = this.target.toArray();
    return this.hold.rotation ? { target, rotation: this.rotation.toArray() as [number, number, number, number] } : { target };
  }

  private send(): void {
    this.unanswered++;
    this.parts.server
      .request("simulation.move_grab", { hand: this.hold.hand, ...this.place() })
      // The run was reset, or the body is gone: there is nothing to hold any more.
      .catch(() => (this.isOver = true))
      .finally(() => {
        this.unanswered--;
        this.follow();
      });
  }
}
