// SPDX-License-Identifier: MIT
import { Quaternion, Vector3 } from "three";
import type { Presence } from "../connection/messages";
import type { Parts } from "../parts";
import type { Grabbing } from "./grabbing";
import type { Hands } from "./hand";
import type { Stance } from "./stance";

type Three = [number, number, number];
type Four = [number, number, number, number];

/** The protocol allows 20 a second. */
const PAUSE_MS = 50;

/** Tells the others where this user's head and hands are. */
export class PresenceSender {
  private last = 0;
  private readonly position = new Vector3();
  private readonly rotation = new Quaternion();

  constructor(
    private readonly parts: Pick<Parts, "people">,
    private readonly hands: Hands,
    private readonly stance: Stance,
    private readonly grabbing: Grabbing,
  ) {}

  update(now: number): void {
    if (now - this.last < PAUSE_MS || this.parts.people.others.length === 0) return;
    this.last = now;
    this.parts.people.put(this.present());
  }

  /** The user has taken the headset off. */
  end(): void {
    this.parts.people.put({ head: null, hands: [], mode: "page" });
  }

  private present(): Presence {
    this.stance.headAt(this.position);
    this.stance.head.getWorldQuaternion(this.rotation);
    const hands = this.hands.both.filter(({ seen }) => seen).map((hand) => {
      const held = this.grabbing.held(hand.side);
      return { hand: hand.side, position: hand.position.toArray() as Three, rotation: hand.rotation.toArray() as Four, ...(held && { holds: held.index }) };
    });
    return { head: { position: this.position.toArray() as Three, rotation: this.rotation.toArray() as Four }, hands, mode: "headset" };
  }
}
