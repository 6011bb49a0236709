// SPDX-License-Identifier: MIT
import { Frustum, Matrix4, type PerspectiveCamera, Sphere, Vector3 } from "three";

/** A coarser level is taken up only where it is well within that, so that levels do not flicker to and fro. */
const CALM = 0.85;
/** What is smaller than this many times the tolerance is not drawn. */
const LEAST_SIZE = 1.3;
/** The level of what is too small to be drawn. */
export const NOTHING = -1;

const joined = new Matrix4();
const sphere = new Sphere();

/** Where pictures are taken from: says what is in view, and in how much detail it must be drawn. */
export class Viewer {
  private readonly frustum = new Frustum();
  private readonly eye = new Vector3();
  /** Pixels that a metre has at a distance of a metre. */
  private pixels = 1;
  private near = 0.1;
  /** A level is drawn where its surface is nearer than this to the full one, pixels. */
  tolerance = 1;
  /** Everything in full detail: for pictures to compare with. */
  full = false;
  /** Things out of view cast shadows into it. */
  hasShadows = false;

  /** `height` of the picture in pixels. */
  look(camera: PerspectiveCamera, height: number): void {
    camera.updateMatrixWorld();
    this.frustum.setFromProjectionMatrix(joined.multiplyMatrices(camera.projectionMatrix, camera.matrixWorldInverse));
    this.eye.setFromMatrixPosition(camera.matrixWorld);
    this.pixels = (height * camera.projectionMatrix.elements[5]!) / 2;
    this.near = camera.near;
  }

  /** Whether a ball is in view: its centre's coordinates and its radius stand in `balls` from `at` on. */
  sees(balls: Float32Array, at: number): boolean {
    if (balls[at + 3] === Infinity) return true;
    sphere.center.set(balls[at]!, balls[at + 1]!, balls[at + 2]!);
    sphere.radius = balls[at + 3]!;
    return this.frustum.intersectsSphere(sphere);
  }

  /**
   * The level of detail for a thing in a ball: 0 is full detail, NOTHING too small. `errors` of the coarser levels in m; the thing's
   * scale stands behind the ball's radius; `before` is the present level. Numbers are read here, so that none is boxed for a call.
   */
  levelFor(balls: Float32Array, at: number, errors: readonly number[], before: number): number {
    const radius = balls[at + 3]!;
    if (this.full || radius === Infinity) return 0;
    const x = balls[at]! - this.eye.x;
    const y = balls[at + 1]! - this.eye.y;
    const z = balls[at + 2]! - this.eye.z;
    const density = this.pixels / Math.max(Math.sqrt(x * x + y * y + z * z) - radius, this.near);
    if (2 * radius * density < LEAST_SIZE * this.tolerance * (before === NOTHING ? 1 / CALM : 1)) return NOTHING;
    const most = this.tolerance / (balls[at + 4]! * density);
    let level = 0;
    while (level < errors.length && errors[level]! <= (level < before || before === NOTHING ? most : CALM * most)) ++level;
    return level;
  }
}
