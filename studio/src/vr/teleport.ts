// SPDX-License-Identifier: MIT
import { BufferGeometry, Color, DynamicDrawUsage, Float32BufferAttribute, Group, Line, LineBasicMaterial, Mesh, MeshBasicMaterial, RingGeometry, CircleGeometry, Vector3 } from "three";
import { BodyState } from "../document/motion";
import type { Parts } from "../parts";
import type { Hand } from "./hand";
import type { Stance } from "./stance";

/** The arc is that of a ball thrown so fast, m/s of the room, and is followed for so long, s. */
const SPEED = 7;
const FALL = 9.81;
const LONGEST_S = 2;
/** Points of the drawn arc; each STRIDE of them one ray looks for what is in the way. */
const POINTS = 33;
const STRIDE = 4;
/** Cosine of the steepest slope, 30°, that one can stand on. */
const STEEPEST = 0.86;
/** A still thing counts as a floor where it is so wide in both directions, m of the room. */
const WIDE = 1.2;
const GOOD = new Color(0xff9d2e);
const BAD = new Color(0x8a93a0);

/** The arc from a hand to where the user would stand, and a ring there. Only floors are allowed. */
export class Teleport {
  readonly group = new Group();
  readonly target = new Vector3();
  aims = false;
  /** Whether one can stand where the arc ends. */
  allowed = false;
  private readonly line: Line<BufferGeometry, LineBasicMaterial>;
  private readonly ring: Mesh<BufferGeometry, MeshBasicMaterial>;
  private readonly disc: Mesh<BufferGeometry, MeshBasicMaterial>;
  private readonly places: Float32Array;
  private readonly from = new Vector3();
  private readonly to = new Vector3();
  private readonly along = new Vector3();

  constructor(
    private readonly parts: Pick<Parts, "document" | "motion" | "entities" | "view">,
    private readonly stance: Stance,
  ) {
    const look = { transparent: true, depthWrite: false, toneMapped: false, fog: false };
    const geometry = new BufferGeometry().setAttribute("position", new Float32BufferAttribute(new Float32Array(3 * POINTS), 3).setUsage(DynamicDrawUsage));
    this.line = new Line(geometry, new LineBasicMaterial({ ...look, linewidth: 3 }));
    this.ring = new Mesh(new RingGeometry(0.2, 0.235, 48), new MeshBasicMaterial({ ...look, opacity: 0.95 }));
    this.disc = new Mesh(new CircleGeometry(0.2, 48), new MeshBasicMaterial({ ...look, opacity: 0.25 }));
    for (const mesh of [this.ring, this.disc]) mesh.rotation.x = -Math.PI / 2;
    for (const object of [this.line, this.ring, this.disc]) {
      object.frustumCulled = false;
      object.renderOrder = 1090;
      object.raycast = () => {};
      this.group.add(object);
    }
    // The attribute copies its array: the points are written into the copy.
    this.places = geometry.getAttribute("position").array as Float32Array;
    this.group.visible = false;
  }

  /** Shows where the hand would take the user. */
  aim(hand: Hand): void {
    this.aims = true;
    this.trace(hand);
    const color = this.allowed ? GOOD : BAD;
    for (const { material } of [this.line, this.ring, this.disc]) material.color.copy(color);
    const { scale } = this.stance;
    for (const mesh of [this.ring, this.disc]) {
      mesh.visible = this.allowed;
      mesh.position.copy(this.target).y += 0.006 * scale;
      mesh.scale.setScalar(scale);
    }
    this.line.geometry.getAttribute("position").needsUpdate = true;
    this.group.visible = true;
  }

  /** Goes there, where one can stand; true if so. */
  go(): boolean {
    const went = this.aims && this.allowed;
    if (went) this.stance.standAt(this.target);
    this.stop();
    return went;
  }

  stop(): void {
    this.aims = false;
    this.group.visible = false;
  }

  /** The floor below a point of the scene, or the ground. */
  floorBelow(point: Vector3, out: Vector3): Vector3 {
    const hit = this.parts.view.cast(point, this.along.set(0, -1, 0));
    return out.set(point.x, hit && this.isFloor(hit.index) ? hit.point.y : 0, point.z);
  }

  private trace(hand: Hand): void {
    const { scale } = this.stance;
    const { places } = this;
    const step = LONGEST_S / (POINTS - 1);
    this.allowed = false;
    let last = POINTS - 1;
    for (let at = 0; at < POINTS; ++at) this.pointAt(hand, at * step, scale).toArray(places, 3 * at);
    for (let at = STRIDE; at < POINTS; at += STRIDE) {
      this.from.fromArray(places, 3 * (at - STRIDE));
      this.to.fromArray(places, 3 * at);
      if (!this.meets()) continue;
      last = at - STRIDE + 1;
      break;
    }
    // What is behind the end lies in it, so that the line stops there.
    for (let at = last; at < POINTS; ++at) this.target.toArray(places, 3 * at);
  }

  private pointAt(hand: Hand, time: number, scale: number): Vector3 {
    this.along.copy(hand.rayOrigin).addScaledVector(hand.rayDirection, SPEED * time * scale);
    this.along.y -= 0.5 * FALL * time * time * scale;
    return this.along;
  }

  /** Whether a piece of the arc ends at something; sets target and allowed. */
  private meets(): boolean {
    this.along.copy(this.to).sub(this.from);
    const length = this.along.length();
    const hit = this.parts.view.cast(this.from, this.along.divideScalar(length), length);
    if (hit) {
      this.target.copy(hit.point);
      this.allowed = hit.normal.y > STEEPEST && this.isFloor(hit.index);
      return true;
    }
    // The ground is a floor also where the scene has none.
    if (this.from.y < 0 || this.to.y > 0 || this.from.y === this.to.y) {
      this.target.copy(this.to);
      return false;
    }
    this.target.lerpVectors(this.from, this.to, this.from.y / (this.from.y - this.to.y));
    this.allowed = true;
    return true;
  }

  private isFloor(index: number): boolean {
    const { document, motion, entities } = this.parts;
    const shape = document.entity(index)?.shape?.type;
    if (shape === "plane" || shape === "heightfield") return true;
    if (motion.state(index) !== BodyState.still) return false;
    const bounds = entities.boundsOf([index], performance.now());
    const wide = WIDE * Math.min(this.stance.scale, 1);
    return bounds.max.x - bounds.min.x >= wide && bounds.max.z - bounds.min.z >= wide;
  }
}
