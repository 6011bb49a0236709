// SPDX-License-Identifier: MIT
import { type Box3, PerspectiveCamera, Spherical, Vector3 } from "three";
import type { Camera, Vector } from "../connection/scene_types";
import { wantsCalm } from "../preferences";
import { Signal } from "../signal";

const ORBIT_PER_PIXEL = 0.006;
const LOOK_PER_PIXEL = 0.004;
const ZOOM_PER_NOTCH = 1.12;
const NEAREST = 0.05;
const FARTHEST = 2000;
const FLY_TIME_MS = 250;
const HIGHEST = Math.PI - 0.02;
const LOWEST = 0.02;
/** What is focused on fills this part of the picture, one over the number; and from no nearer than this, m. */
const MARGIN = 1.2;
const LEAST_FOCUS = 0.3;
/** Vertical angle of view in degrees, while the picture is at least this many times as wide as high. */
const VIEW_ANGLE = 45;
const USUAL_ASPECT = 1.4;
/** Of the plan: so narrow that nothing is seen in perspective. */
const PLAN_ANGLE = 1;
const PLAN_TILT = 1e-4;
const NEAR = 0.03;
const FAR = 3000;

/** The camera: it looks at a target from a distance; orbits, pans, zooms and flies. The caller decides which gesture means what. */
export class CameraRig {
  readonly camera = new PerspectiveCamera(VIEW_ANGLE, 1, NEAR, FAR);
  readonly target = new Vector3(0, 0.5, 0);
  readonly changed = new Signal<void>();
  /** The user moved the camera. */
  readonly steered = new Signal<void>();
  /** The plan is shown, or not any more. */
  readonly planned = new Signal<void>();
  private readonly arm = new Spherical(6, 1.15, 0.6);
  /** Metres per second to the right, up and back while flying. */
  private readonly flight = new Vector3();
  private glide: { fromTarget: Vector3; toTarget: Vector3; fromArm: Spherical; toArm: Spherical; start: number } | null = null;
  private readonly step = new Vector3();
  /** While the plan is shown: where the camera was. */
  private before: { arm: Spherical; target: Vector3 } | null = null;

  constructor() {
    this.apply();
  }

  get distance(): number {
    return this.arm.radius;
  }

  /** The distance from which the picture would show as much at the usual angle. */
  get reach(): number {
    return this.before ? this.arm.radius / planFactor() : this.arm.radius;
  }

  get isPlan(): boolean {
    return this.before !== null;
  }

  /** The plan: from straight above, north up, without perspective; and back to where the camera was. */
  setPlan(on: boolean): void {
    if (on === this.isPlan) return;
    this.glide = null;
    if (this.before) {
      const { arm, target } = this.before;
      // Back over the place that the plan showed last.
      this.target.set(this.target.x, target.y, this.target.z);
      this.arm.copy(arm);
      this.before = null;
    } else {
      this.before = { arm: this.arm.clone(), target: this.target.clone() };
      this.arm.set(this.arm.radius * planFactor(), PLAN_TILT, 0);
    }
    this.fit(this.camera.aspect);
    this.apply();
    this.planned.emit();
  }

  /** Where the camera is and what it looks at, in millimetres; of the plan what was seen before it. */
  seen(): Camera {
    if (this.before) return { position: new Vector3().setFromSpherical(this.before.arm).add(this.before.target).toArray() as Vector, target: this.before.target.toArray() as Vector };
    const round = (length: number) => Math.round(length * 1000) / 1000;
    return { position: this.camera.position.toArray().map(round) as Vector, target: this.target.toArray().map(round) as Vector };
  }

  /** Takes over the picture's aspect; in a narrow picture the horizontal angle of view stays the usual one. */
  fit(aspect: number): void {
    this.camera.aspect = aspect;
    const slope = Math.tan(((this.before ? PLAN_ANGLE : VIEW_ANGLE) * Math.PI) / 360) * Math.max(1, USUAL_ASPECT / aspect);
    this.camera.fov = Math.min((360 / Math.PI) * Math.atan(slope), 80);
    this.camera.updateProjectionMatrix();
  }

  /** In the plan nothing turns. */
  orbit(dx: number, dy: number): void {
    this.steer();
    if (this.before) return;
    this.arm.theta -= dx * ORBIT_PER_PIXEL;
    this.arm.phi = clamp(this.arm.phi - dy * ORBIT_PER_PIXEL, LOWEST, HIGHEST);
    this.apply();
  }

  /** Moves the target so that the point under the pointer stays under it; `height` is the canvas's, in pixels. */
  pan(dx: number, dy: number, height: number): void {
    this.steer();
    const metresPerPixel = (2 * this.arm.radius * Math.tan((this.camera.fov * Math.PI) / 360)) / height;
    this.step.setFromMatrixColumn(this.camera.matrix, 0).multiplyScalar(-dx * metresPerPixel);
    this.target.add(this.step);
    this.step.setFromMatrixColumn(this.camera.matrix, 1).multiplyScalar(dy * metresPerPixel);
    this.target.add(this.step);
    this.apply();
  }

  zoom(notches: number): void {
    this.steer();
    const factor = this.before ? planFactor() : 1;
    this.arm.radius = clamp(this.arm.radius * ZOOM_PER_NOTCH ** notches, NEAREST * factor, FARTHEST * factor);
    this.apply();
  }

  /** Rotates the view: the camera stays, the target moves around it. */
  look(dx: number, dy: number): void {
    this.steer();
    if (this.before) return;
    const eye = this.camera.position.clone();
    this.arm.theta -= dx * LOOK_PER_PIXEL;
    this.arm.phi = clamp(this.arm.phi - dy * LOOK_PER_PIXEL, LOWEST, HIGHEST);
    this.target.copy(eye).sub(this.step.setFromSpherical(this.arm));
    this.apply();
  }

  /** Sets the direction of flight, -1 … 1 along right, up and back; zero stops. */
  fly(right: number, up: number, back: number): void {
    if (right || up || back) this.steer();
    const speed = Math.max(1, 0.8 * this.reach);
    this.flight.set(right, up, back).multiplyScalar(speed);
    this.changed.emit();
  }

  /** Moves smoothly, or jumps, until the box fills most of the picture. */
  focus(bounds: Box3, now: number, jump = false): void {
    if (bounds.isEmpty()) return;
    const toArm = this.arm.clone();
    const toTarget = bounds.getCenter(new Vector3());
    const factor = this.before ? planFactor() : 1;
    toArm.radius = clamp(this.distanceFor(bounds, toTarget), NEAREST * factor, FARTHEST * factor);
    this.glideTo(toTarget, toArm, jump ? now - FLY_TIME_MS : now);
    if (jump) this.advance(now, 0);
  }

  /** Moves smoothly to `position`, looking at `target`. */
  goTo(position: readonly number[], target: readonly number[], now: number): void {
    this.setPlan(false);
    const toTarget = new Vector3().fromArray(target);
    const toArm = armTo(position, toTarget);
    // The shorter way around.
    toArm.theta += 2 * Math.PI * Math.round((this.arm.theta - toArm.theta) / (2 * Math.PI));
    this.glideTo(toTarget, toArm, now);
  }

  /** The user's hand counts more than a smooth move that is going on. */
  private steer(): void {
    this.glide = null;
    this.steered.emit();
  }

  private glideTo(toTarget: Vector3, toArm: Spherical, start: number): void {
    this.glide = { fromTarget: this.target.clone(), toTarget, fromArm: this.arm.clone(), toArm, start: wantsCalm() ? -Infinity : start };
    this.changed.emit();
  }

  /** The distance from the box's centre at which, seen from the present side, all its corners are in the picture. */
  private distanceFor(bounds: Box3, centre: Vector3): number {
    this.camera.updateMatrix();
    const toCamera = this.camera.quaternion.clone().invert();
    const upright = Math.tan((this.camera.fov * Math.PI) / 360);
    const corner = new Vector3();
    let distance = 0;
    for (let which = 0; which < 8; ++which) {
      corner.set(which & 1 ? bounds.max.x : bounds.min.x, which & 2 ? bounds.max.y : bounds.min.y, which & 4 ? bounds.max.z : bounds.min.z);
      corner.sub(centre).applyQuaternion(toCamera);
      const across = Math.max(Math.abs(corner.y) / upright, Math.abs(corner.x) / (upright * this.camera.aspect));
      distance = Math.max(distance, corner.z + MARGIN * across);
    }
    return Math.max(distance, LEAST_FOCUS);
  }

  /** Puts the camera at `position`, looking at `target`. */
  place(position: readonly number[], target: readonly number[]): void {
    this.setPlan(false);
    this.target.fromArray(target);
    this.arm.copy(armTo(position, this.target));
    this.glide = null;
    this.apply();
  }

  /** Continues flights and smooth moves; returns whether they go on. */
  advance(now: number, seconds: number): boolean {
    const flying = this.flight.lengthSq() > 0;
    if (flying) {
      this.step.copy(this.flight).multiplyScalar(seconds).applyQuaternion(this.camera.quaternion);
      this.target.add(this.step);
    }
    if (this.glide) {
      const part = Math.min((now - this.glide.start) / FLY_TIME_MS, 1);
      const eased = part * part * (3 - 2 * part);
      this.target.lerpVectors(this.glide.fromTarget, this.glide.toTarget, eased);
      const { fromArm, toArm } = this.glide;
      const between = (from: number, to: number) => from + (to - from) * eased;
      this.arm.set(between(fromArm.radius, toArm.radius), between(fromArm.phi, toArm.phi), between(fromArm.theta, toArm.theta));
      if (part >= 1) this.glide = null;
    }
    if (flying || this.glide) this.apply();
    else this.pose();
    return flying || this.glide !== null;
  }

  private apply(): void {
    this.pose();
    this.changed.emit();
  }

  private pose(): void {
    this.camera.position.setFromSpherical(this.arm).add(this.target);
    this.camera.lookAt(this.target);
    const near = this.before ? Math.max(NEAR, 0.5 * this.arm.radius) : NEAR;
    if (this.camera.near !== near) {
      this.camera.near = near;
      this.camera.far = this.before ? 1.5 * this.arm.radius + FAR : FAR;
      this.camera.updateProjectionMatrix();
    }
    this.camera.updateMatrix();
  }
}

/** So many times farther away the plan is seen from. */
function planFactor(): number {
  return Math.tan((VIEW_ANGLE * Math.PI) / 360) / Math.tan((PLAN_ANGLE * Math.PI) / 360);
}

/** The arm from the target to the position. */
function armTo(position: readonly number[], target: Vector3): Spherical {
  const arm = new Spherical().setFromVector3(new Vector3().fromArray(position).sub(target));
  arm.radius = clamp(arm.radius, NEAREST, FARTHEST);
  arm.phi = clamp(arm.phi, LOWEST, HIGHEST);
  return arm;
}

function clamp(value: number, low: number, high: number): number {
  return Math.min(Math.max(value, low), high);
}
