// SPDX-License-Identifier: MIT
import { Box3, Matrix4, Quaternion, Vector3 } from "three";
import type { Simulation } from "../connection/messages";
import type { Parts } from "../parts";
import { Signal } from "../signal";
import { scaleEntities } from "../tools/gizmo";
import { restOn } from "../tools/rest_on";
import { type HeldPose, PoseDrag, presentPoses } from "../tools/poses";
import type { Hand, Hands, Side } from "./hand";
import { isMovable } from "./near";
import { Pull } from "../tools/pull";
import type { Stance } from "./stance";

const UP = new Vector3(0, 1, 0);
/** A far thing comes and goes by its own distance so many times a second, and turns so fast, rad/s, at a stick's full deflection. */
const REEL_RATE = 1.6;
const TURN_RATE = 2;
/** Moves of the hand that are smaller than this count as none, m of the room, and rad of the ray and of the hand. */
const TREMBLE = 0.006;
const TREMBLE_ANGLE = 0.02;
const TREMBLE_TURN = 0.06;
/** A held thing comes no nearer to the hand than this, m of the room. */
const NEAREST = 0.12;

/** What one hand holds. */
export interface Hold {
  readonly index: number;
  /** By the ray, so far away (m of the scene); null: in the hand. */
  distance: number | null;
  /** Of the thing in the frame of the hand. */
  readonly offset: Vector3;
  readonly turn: Quaternion;
  /** The point that is held, in the thing's frame. */
  readonly hook: Vector3;
  /** Turned by the stick about the vertical, rad. */
  spin: number;
  /** The user has chosen a distance: the thing leaves the surfaces. */
  floats: boolean;
  /** Where the hand took it; a hand that trembles while it only points moves nothing. */
  readonly from: Vector3;
  moved: boolean;
  readonly pull: Pull | null;
}

/** Grabs things with hands and rays: moves them by one edit while the scene stands, pulls at them while it plays. */
export class Grabbing {
  readonly changed = new Signal<void>();
  private readonly holds: Record<Side, Hold | null> = { left: null, right: null };
  private readonly drags = new Map<number, PoseDrag>();
  /** With two hands on one thing: it and the hands when the second one came. */
  private pair: { room: number; along: Vector3; middle: Vector3; position: Vector3; rotation: Quaternion; scale: number } | null = null;
  /** State and step of the run when it was last told. */
  private run: Pick<Simulation, "state" | "step"> = { state: "stopped", step: 0 };
  private factor = 1;
  private shown = 1;
  private readonly frame = { position: new Vector3(), rotation: new Quaternion() };
  private readonly places = { left: new Vector3(), right: new Vector3() };
  private readonly place = new Vector3();
  private readonly rotation = new Quaternion();
  private readonly spinBy = new Quaternion();
  private readonly along = new Vector3();
  private readonly middle = new Vector3();
  private readonly matrix = new Matrix4();
  private readonly bounds = new Box3();
  private readonly ignored = new Set<number>();

  constructor(
    private readonly parts: Pick<Parts, "preferences" | "server" | "document" | "playback" | "selection" | "motion" | "entities" | "view">,
    private readonly hands: Hands,
    private readonly stance: Stance,
  ) {
    // Held things change hands with the state: what the run held is let go, what was being placed is put down. A run that
    // only became slower, faster or longer goes on, and so does the hold.
    parts.playback.changed.on(() => {
      const { state, step } = parts.playback.simulation;
      if (state !== this.run.state || step < this.run.step) this.releaseAll();
      this.run = { state, step };
    });
    parts.document.changed.on(({ all, removed }) => {
      for (const side of ["left", "right"] as const) if (all || removed.includes(this.holds[side]?.index ?? -1)) this.release(side);
    });
  }

  held(side: Side): Hold | null {
    return this.holds[side];
  }

  get isStopped(): boolean {
    return this.parts.playback.simulation.state === "stopped";
  }

  /** Takes an entity at a point of it: into the hand, or by the ray where `distance` tells how far it is. */
  grab(hand: Hand, index: number, point: Vector3, distance: number | null): boolean {
    if (!isMovable(this.parts, index)) return false;
    const pose = presentPoses(this.parts, [index]).get(index);
    if (!pose) return false;
    this.release(hand.side);
    this.frameOf(hand, distance);
    const inverse = this.frame.rotation.clone().invert();
    const hold: Hold = {
      index,
      distance,
      offset: pose.position.clone().sub(this.frame.position).applyQuaternion(inverse),
      turn: inverse.clone().multiply(pose.rotation),
      hook: point.clone().sub(pose.position).applyQuaternion(pose.rotation.clone().invert()),
      spin: 0,
      floats: false,
      from: this.frame.position.clone(),
      moved: false,
      pull: this.isStopped ? null : new Pull(this.parts, { index, point, rotation: pose.rotation, hand: hand.side, strength: this.parts.preferences.get("vr").strength }),
    };
    this.holds[hand.side] = hold;
    this.parts.selection.set([index]);
    this.startPair();
    this.changed.emit();
    return true;
  }

  release(side: Side): void {
    const hold = this.holds[side];
    if (!hold) return;
    this.holds[side] = null;
    if (hold.pull) {
      this.moveByOne(this.hands.of(side), hold);
      hold.pull.release();
    }
    const other = this.holds[side === "left" ? "right" : "left"];
    if (other && other.index === hold.index) this.anchor(this.hands.of(side === "left" ? "right" : "left"), other);
    else this.endDrag(hold.index);
    this.pair = null;
    this.changed.emit();
  }

  releaseAll(): void {
    this.release("left");
    this.release("right");
  }

  update(seconds: number): void {
    const { left, right } = this.holds;
    if (!left && !right) return;
    for (const hand of this.hands.both) {
      const hold = this.holds[hand.side];
      if (hold) this.steer(hand, hold, seconds);
    }
    if (this.pair && left && right) this.moveByBoth(left, right);
    else {
      if (left) this.moveByOne(this.hands.left, left);
      if (right && right.index !== left?.index) this.moveByOne(this.hands.right, right);
    }
  }

  /** The stick of a hand that holds something far draws it near, sends it off and turns it. */
  private steer(hand: Hand, hold: Hold, seconds: number): void {
    hold.spin -= hand.stickX * TURN_RATE * seconds;
    if (hold.distance === null || hand.stickY === 0) return;
    hold.floats = true;
    const least = NEAREST * this.stance.scale;
    hold.distance = Math.max(hold.distance * Math.exp(-hand.stickY * REEL_RATE * seconds), least);
  }

  /** Sets `frame` to that of the hand: where a thing that it holds is attached. */
  private frameOf(hand: Hand, distance: number | null): void {
    if (distance === null) this.frame.position.copy(hand.position);
    else this.frame.position.copy(hand.rayOrigin).addScaledVector(hand.rayDirection, distance);
    this.frame.rotation.copy(hand.rotation);
  }

  /** Where the hand has brought the thing: sets `place` and `rotation`. */
  private carry(hand: Hand, hold: Hold): void {
    this.frameOf(hand, hold.distance);
    this.spinBy.setFromAxisAngle(UP, hold.spin);
    this.rotation.copy(this.frame.rotation).multiply(hold.turn).premultiply(this.spinBy);
    this.place.copy(hold.offset).applyQuaternion(this.frame.rotation).applyQuaternion(this.spinBy).add(this.frame.position);
  }

  private moveByOne(hand: Hand, hold: Hold): void {
    this.carry(hand, hold);
    if (hold.pull) {
      hold.pull.target.copy(hold.hook).applyQuaternion(this.rotation).add(this.place);
      hold.pull.rotation.copy(this.rotation);
      hold.pull.follow();
      return;
    }
    if (!hold.moved && !this.hasMoved(hold)) return;
    this.dragOf(hold.index);
    if (hold.distance !== null && !hold.floats) this.lay(hand, hold);
    this.snap();
    this.show(hold.index, 1);
  }

  private hasMoved(hold: Hold): boolean {
    const tremble = Math.max(TREMBLE * this.stance.scale, TREMBLE_ANGLE * (hold.distance ?? 0));
    const turned = hold.distance === null && 2 * Math.acos(Math.min(Math.abs(this.rotation.dot(this.startRotation(hold))), 1)) > TREMBLE_TURN;
    hold.moved = hold.floats || hold.spin !== 0 || turned || this.frame.position.distanceTo(hold.from) > tremble;
    return hold.moved;
  }

  private startRotation(hold: Hold): Quaternion {
    this.parts.motion.pose(hold.index, performance.now(), this.middle, this.spinBy);
    return this.spinBy;
  }

  /** A thing on a ray lies on the surface that the ray meets, upright as it was. */
  private lay(hand: Hand, hold: Hold): void {
    const start = this.drags.get(hold.index)?.start.get(hold.index);
    const drawable = this.parts.entities.drawableOf(hold.index);
    if (!start || !drawable) return;
    this.ignored.clear();
    this.ignored.add(hold.index);
    const hit = this.parts.view.cast(hand.rayOrigin, hand.rayDirection, Infinity, this.ignored);
    this.rotation.copy(start.rotation).premultiply(this.spinBy);
    if (!hit) return;
    this.matrix.compose(this.place.set(0, 0, 0), this.rotation, this.along.setScalar(start.scale));
    restOn(this.bounds.copy(drawable.bounds).applyMatrix4(this.matrix), hit.point, hit.normal, this.place);
    hold.distance = Math.max(hit.distance, NEAREST * this.stance.scale);
  }

  private snap(): void {
    const { preferences } = this.parts;
    if (!preferences.get("snap")) return;
    const step = preferences.get("snapLength");
    // The height follows the surface below.
    this.place.x = Math.round(this.place.x / step) * step;
    this.place.z = Math.round(this.place.z / step) * step;
    snapTurn(this.rotation, (preferences.get("snapAngle") * Math.PI) / 180);
  }

  /** Sets the pose that is drawn; kept, so that no function is made for a picture. */
  private readonly follow = (pose: HeldPose, start: HeldPose): void => {
    pose.position.copy(this.place);
    pose.rotation.copy(this.rotation);
    pose.scale = start.scale * this.shown;
  };

  private dragOf(index: number): PoseDrag {
    let drag = this.drags.get(index);
    if (!drag) this.drags.set(index, (drag = new PoseDrag(this.parts, [index])));
    return drag;
  }

  private show(index: number, factor: number): void {
    this.shown = factor;
    const drag = this.dragOf(index);
    drag.hold(index, this.follow);
    drag.send();
  }

  /** The second hand has come to the same thing. */
  private startPair(): void {
    const { left, right } = this.holds;
    this.pair = null;
    if (!left || !right || left.index !== right.index) return;
    const pose = presentPoses(this.parts, [left.index]).get(left.index);
    if (!pose) return;
    this.spot("left", left);
    this.spot("right", right);
    const along = this.places.right.clone().sub(this.places.left);
    this.pair = { room: Math.max(along.length(), 1e-3), along: along.normalize(), middle: this.places.left.clone().add(this.places.right).multiplyScalar(0.5), ...pose };
  }

  private spot(side: Side, hold: Hold): void {
    this.frameOf(this.hands.of(side), hold.distance);
    this.places[side].copy(this.frame.position);
  }

  /** Both hands turn the thing with the line between them and, while the scene stands, make it larger and smaller. */
  private moveByBoth(left: Hold, right: Hold): void {
    const pair = this.pair!;
    this.spot("left", left);
    this.spot("right", right);
    this.along.copy(this.places.right).sub(this.places.left);
    const length = this.along.length();
    this.middle.copy(this.places.left).add(this.places.right).multiplyScalar(0.5);
    const factor = this.isStopped && this.canScale(left.index) ? Math.max(length / pair.room, 0.02) : 1;
    this.spinBy.setFromUnitVectors(pair.along, this.along.normalize());
    this.rotation.copy(pair.rotation).premultiply(this.spinBy);
    this.place.copy(pair.position).sub(pair.middle).applyQuaternion(this.spinBy).multiplyScalar(factor).add(this.middle);
    if (!left.pull || !right.pull) {
      this.snap();
      const start = this.dragOf(left.index).start.get(left.index);
      this.factor = start ? (factor * pair.scale) / start.scale : factor;
      this.show(left.index, this.factor);
      return;
    }
    for (const { pull, hook } of [left, right]) {
      pull!.target.copy(hook).applyQuaternion(this.rotation).add(this.place);
      pull!.rotation.copy(this.rotation);
      pull!.follow();
    }
  }

  private canScale(index: number): boolean {
    const entity = this.parts.document.entity(index);
    return entity !== undefined && (entity.model !== undefined || entity.shape?.type !== "compound");
  }

  /** Starts the hold anew from where the thing is now: the other hand has let go. */
  private anchor(hand: Hand, hold: Hold): void {
    const pose = presentPoses(this.parts, [hold.index]).get(hold.index);
    if (!pose) return;
    this.frameOf(hand, hold.distance);
    const inverse = this.frame.rotation.clone().invert();
    hold.offset.copy(pose.position).sub(this.frame.position).applyQuaternion(inverse);
    hold.turn.copy(inverse).multiply(pose.rotation);
    hold.spin = 0;
    hold.floats = hold.moved = true;
  }

  private endDrag(index: number): void {
    const { factor } = this;
    const drag = this.drags.get(index);
    this.drags.delete(index);
    this.factor = 1;
    if (!drag) return;
    if (Math.abs(factor - 1) > 1e-3) void scaleEntities(this.parts, drag, factor);
    else void drag.end();
  }
}

const up = new Vector3();
const forth = new Vector3();
const snapBy = new Quaternion();
const uprightBy = new Quaternion();

/** Turns to the nearest step about the vertical; what leans by less than half a step is set upright. */
function snapTurn(rotation: Quaternion, step: number): void {
  up.set(0, 1, 0).applyQuaternion(rotation);
  forth.set(0, 0, 1).applyQuaternion(rotation);
  const angle = Math.atan2(forth.x, forth.z);
  snapBy.setFromAxisAngle(UP, Math.round(angle / step) * step - angle);
  if (up.y > Math.cos(step / 2)) snapBy.multiply(uprightBy.setFromUnitVectors(up, UP));
  rotation.premultiply(snapBy);
}
