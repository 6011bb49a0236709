// SPDX-License-Identifier: MIT
import { Vector3 } from "three";
import { BodyState } from "../document/motion";
import type { Parts } from "../parts";
import type { Hand, Hands, Side } from "./hand";
import type { Stance } from "./stance";
import { Teleport } from "./teleport";
import { Vignette } from "./vignette";

/** m/s of the room, and rad/s. */
const WALK_SPEED = 2;
const TURN_SPEED = 1.6;
/** A stick pushed so far begins to aim or turns by a step; below the second it is ready for the next. */
const PUSHED = 0.7;
const REST = 0.35;
/** Walls stop the user this far before the head, and things lower than this are stepped over, m of the room. */
const WALL_GAP = 0.35;
const KNEE = 0.5;

/** Moves the user: teleport, walking, turning, and the whole world by two hands. */
export class Moving {
  readonly teleport: Teleport;
  readonly vignette = new Vignette();
  /** The hand whose stick aims. */
  private aiming: Side | null = null;
  private turned = false;
  private isSmooth = false;
  /** Where in the scene the two hands have hold of the world. */
  private world: [Vector3, Vector3] | null = null;
  private readonly anchors: [Vector3, Vector3] = [new Vector3(), new Vector3()];
  private readonly step = new Vector3();
  private readonly aside = new Vector3();
  private readonly chest = new Vector3();
  private rooms: [Vector3, Vector3];

  constructor(
    private readonly parts: Pick<Parts, "preferences" | "document" | "playback" | "motion" | "entities" | "view">,
    private readonly hands: Hands,
    private readonly stance: Stance,
    /** Whether the hand's stick and buttons are needed for something else. */
    private readonly isTaken: (hand: Hand) => boolean,
  ) {
    this.teleport = new Teleport(parts, stance);
    stance.head.add(this.vignette.mesh);
    parts.view.scene.add(this.teleport.group);
    this.rooms = [hands.left.room, hands.right.room];
  }

  get holdsWorld(): boolean {
    return this.world !== null;
  }

  update(seconds: number): void {
    this.isSmooth = false;
    this.moveWorld();
    for (const hand of this.hands.both) if (!this.isTaken(hand) || this.aiming === hand.side) this.steer(hand, seconds);
    const { vignette } = this.parts.preferences.get("vr");
    this.vignette.update(this.isSmooth ? vignette : 0, seconds);
  }

  /** A tracked hand has no stick: a pinch that points at the floor aims, and letting go goes there. */
  aimByPinch(hand: Hand): void {
    if (hand.isTracked) this.aiming = hand.side;
  }

  stop(): void {
    this.aiming = null;
    this.world = null;
    this.teleport.stop();
  }

  private steer(hand: Hand, seconds: number): void {
    const settings = this.parts.preferences.get("vr");
    const walks = settings.walk && hand.side === "left";
    const forward = -hand.stickY;
    if (walks) this.walk(hand, seconds);
    else if (this.aiming === null && forward > PUSHED && Math.abs(hand.stickX) < PUSHED) this.aiming = hand.side;
    if (this.aiming === hand.side) {
      const ends = hand.isTracked ? !hand.trigger.held : forward < REST;
      if (!ends) this.teleport.aim(hand);
      else {
        this.aiming = null;
        if (this.teleport.go()) hand.pulse(0.4, 25);
      }
      return;
    }
    if (!walks) this.turn(hand, settings.turn, settings.turnAngle, seconds);
  }

  private turn(hand: Hand, kind: "snap" | "smooth", angle: number, seconds: number): void {
    if (hand.side === "left" && this.hands.right.seen) return;
    if (kind === "smooth") {
      if (hand.stickX === 0) return;
      this.isSmooth = true;
      this.stance.turn(-hand.stickX * TURN_SPEED * seconds);
      return;
    }
    if (Math.abs(hand.stickX) < REST) this.turned = false;
    if (this.turned || Math.abs(hand.stickX) < PUSHED) return;
    this.turned = true;
    this.stance.turn((-Math.sign(hand.stickX) * angle * Math.PI) / 180);
  }

  private walk(hand: Hand, seconds: number): void {
    if (hand.stickX === 0 && hand.stickY === 0) return;
    this.isSmooth = true;
    const forth = this.stance.facing(this.step);
    this.aside.set(-forth.z, 0, forth.x).multiplyScalar(hand.stickX);
    forth.multiplyScalar(-hand.stickY).add(this.aside);
    const speed = Math.min(forth.length(), 1) * WALK_SPEED * this.stance.scale;
    forth.normalize();
    if (this.parts.preferences.get("vr").walls && this.isBlocked(forth)) return;
    this.stance.moveBy(forth.multiplyScalar(speed * seconds));
  }

  /** Whether something that doesn't move is right ahead, at the height of the knees or the head. */
  private isBlocked(direction: Vector3): boolean {
    const { view, motion } = this.parts;
    const { scale } = this.stance;
    const still = (height: number | null): boolean => {
      if (height === null) this.stance.headAt(this.chest);
      else this.stance.feetAt(this.chest).y += height * scale;
      const hit = view.cast(this.chest, direction, WALL_GAP * scale);
      return hit !== null && motion.state(hit.index) === BodyState.still;
    };
    return still(null) || still(KNEE);
  }

  /** Both hands squeeze and hold nothing: the world goes with them, turned and scaled. */
  private moveWorld(): void {
    const { left, right } = this.hands;
    const both = left.squeeze.held && right.squeeze.held && left.seen && right.seen;
    if (!both || this.isTaken(left) || this.isTaken(right)) {
      this.world = null;
      return;
    }
    this.rooms[0] = left.room;
    this.rooms[1] = right.room;
    if (!this.world) {
      this.anchors[0].copy(left.room).applyMatrix4(this.stance.origin.matrixWorld);
      this.anchors[1].copy(right.room).applyMatrix4(this.stance.origin.matrixWorld);
      this.world = this.anchors;
      return;
    }
    this.stance.fit(this.rooms, this.world);
  }
}
