// SPDX-License-Identifier: MIT
import { type Box3, PerspectiveCamera, Spherical, Vector3 } from "three";
import { Signal } from "../signal";

const ORBIT_PER_PIXEL = 0.006;
const LOOK_PER_PIXEL = 0.004;
const ZOOM_PER_NOTCH = 1.12;
const NEAREST = 0.05;
const FARTHEST = 2000;
const FLY_TIME_MS = 250;
const HIGHEST = Math.PI - 0.02;
const LOWEST = 0.02;
/** Vertical angle of view in degrees, while the picture is at least this many times as wide as high. */
const VIEW_ANGLE = 45;
const USUAL_ASPECT = 1.4;

/** The camera: it looks at a target from a distance; orbits, pans, zooms and flies. The caller decides which gesture means what. */
export class CameraRig {
  readonly camera = new PerspectiveCamera(VIEW_ANGLE, 1, 0.03, 3000);
  readonly target = new Vector3(0, 0.5, 0);
  readonly changed = new Signal<void>();
  private readonly arm = new Spherical(6, 1.15, 0.6);
  /** Metres per second to the right, up and back while flying. */
  private readonly flight = new Vector3();
  private glide: { fromTarget: Vector3; toTarget: Vector3; fromRadius: number; toRadius: number; start: number } | null = null;
  private readonly step = new Vector3();

  constructor() {
    this.apply();
  }

  get distance(): number {
    return this.arm.radius;
  }

  /** Takes over the picture's aspect; in a narrow picture the horizontal angle of view stays the usual one. */
  fit(aspect: number): void {
    this.camera.aspect = aspect;
    const slope = Math.tan((VIEW_ANGLE * Math.PI) / 360) * Math.max(1, USUAL_ASPECT / aspect);
    this.camera.fov = Math.min((360 / Math.PI) * Math.atan(slope), 80);
    this.camera.updateProjectionMatrix();
  }

  orbit(dx: number, dy: number): void {
    this.arm.theta -= dx * ORBIT_PER_PIXEL;
    this.arm.phi = clamp(this.arm.phi - dy * ORBIT_PER_PIXEL, LOWEST, HIGHEST);
    this.apply();
  }

  /** Moves the target so that the point under the pointer stays under it; `height` is the canvas's, in pixels. */
  pan(dx: number, dy: number, height: number): void {
    const metresPerPixel = (2 * this.arm.radius * Math.tan((this.camera.fov * Math.PI) / 360)) / height;
    this.step.setFromMatrixColumn(this.camera.matrix, 0).multiplyScalar(-dx * metresPerPixel);
    this.target.add(this.step);
    this.step.setFromMatrixColumn(this.camera.matrix, 1).multiplyScalar(dy * metresPerPixel);
    this.target.add(this.step);
    this.apply();
  }

  zoom(notches: number): void {
    this.arm.radius = clamp(this.arm.radius * ZOOM_PER_NOTCH ** notches, NEAREST, FARTHEST);
    this.apply();
  }

  /** Rotates the view: the camera stays, the target moves around it. */
  look(dx: number, dy: number): void {
    const eye = this.camera.position.clone();
    this.arm.theta -= dx * LOOK_PER_PIXEL;
    this.arm.phi = clamp(this.arm.phi - dy * LOOK_PER_PIXEL, LOWEST, HIGHEST);
    this.target.copy(eye).sub(this.step.setFromSpherical(this.arm));
    this.apply();
  }

  /** Sets the direction of flight, -1 … 1 along right, up and back; zero stops. */
  fly(right: number, up: number, back: number): void {
    const speed = Math.max(1, 0.8 * this.arm.radius);
    this.flight.set(right, up, back).multiplyScalar(speed);
    this.changed.emit();
  }

  /** Moves smoothly, or jumps, until the box fills most of the picture. */
  focus(bounds: Box3, now: number, jump = false): void {
    if (bounds.isEmpty()) return;
    const radius = Math.max(0.5 * bounds.getSize(this.step).length(), 0.1);
    const narrow = Math.min(1, this.camera.aspect);
    const distance = (1.25 * radius) / (Math.sin((this.camera.fov * Math.PI) / 360) * narrow);
    this.glide = {
      fromTarget: this.target.clone(),
      toTarget: bounds.getCenter(new Vector3()),
      fromRadius: this.arm.radius,
      toRadius: clamp(distance, NEAREST, FARTHEST),
      start: jump ? now - FLY_TIME_MS : now,
    };
    if (jump) this.advance(now, 0);
    this.changed.emit();
  }

  /** Puts the camera at `position`, looking at `target`. */
  place(position: readonly number[], target: readonly number[]): void {
    this.target.fromArray(target);
    this.arm.setFromVector3(this.step.fromArray(position).sub(this.target));
    this.arm.radius = Math.max(this.arm.radius, NEAREST);
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
      this.arm.radius = this.glide.fromRadius + (this.glide.toRadius - this.glide.fromRadius) * eased;
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
    this.camera.updateMatrix();
  }
}

function clamp(value: number, low: number, high: number): number {
  return Math.min(Math.max(value, low), high);
}
