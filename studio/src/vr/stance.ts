// SPDX-License-Identifier: MIT
import { type Box3, Group, PerspectiveCamera, Quaternion, Vector3 } from "three";

const UP = new Vector3(0, 1, 0);
/** Scene metres in a metre of the user's room while the scene lies on a table as a dollhouse. */
export const DOLLHOUSE = 10;
/** Height of that table, and its free edge before the user, m of the room. */
const TABLE_HEIGHT = 0.85;
const TABLE_GAP = 0.35;
/** Least and greatest size of the user, times life-size. */
const SMALLEST = 0.05;
const LARGEST = 200;

/**
 * Where the user's room is in the scene. `origin` is the room's floor: what hangs in it (head, hands, panels) is in metres of the
 * room, and its scale is how many metres of the scene one of these is.
 */
export class Stance {
  readonly origin = new Group();
  readonly head = new PerspectiveCamera(70, 1, 0.03, 3000);
  /** The middle between the eyes, in the room; three.js' camera of a headset may be at one of them. */
  readonly eyes = new Vector3();
  /** How much higher the head is than in the user's room, for whoever sits, m of the room. */
  lift = 0;
  private readonly point = new Vector3();
  private readonly other = new Vector3();
  private readonly turnBy = new Quaternion();

  constructor() {
    this.origin.add(this.head);
  }

  get scale(): number {
    return this.origin.scale.x;
  }

  /** Call after the origin was moved, and once a picture. */
  refresh(): void {
    this.origin.updateMatrix();
    this.origin.updateMatrixWorld(true);
  }

  /** The head in the scene. */
  headAt(out: Vector3): Vector3 {
    return out.copy(this.eyes).applyMatrix4(this.origin.matrixWorld);
  }

  /** The point of the floor below the head, in the scene. */
  feetAt(out: Vector3): Vector3 {
    return out.set(this.eyes.x, -this.lift, this.eyes.z).applyMatrix4(this.origin.matrixWorld);
  }

  /** Where the head looks along the ground, in the scene. */
  facing(out: Vector3): Vector3 {
    out.set(0, 0, -1).applyQuaternion(this.head.quaternion).applyQuaternion(this.origin.quaternion).setY(0);
    return out.lengthSq() < 1e-6 ? out.set(0, 0, -1) : out.normalize();
  }

  /** Stands the user with the feet at a point of the scene. */
  standAt(feet: Vector3): void {
    this.origin.position.add(this.other.copy(feet).sub(this.feetAt(this.point)));
    this.refresh();
  }

  setLift(lift: number): void {
    if (lift === this.lift) return;
    const feet = this.feetAt(new Vector3());
    this.lift = lift;
    this.standAt(feet);
  }

  moveBy(shift: Vector3): void {
    this.origin.position.add(shift);
    this.refresh();
  }

  /** Turns the user about the head; positive angles to the left, rad. */
  turn(angle: number): void {
    this.feetAt(this.point);
    this.turnBy.setFromAxisAngle(UP, angle);
    this.origin.quaternion.premultiply(this.turnBy);
    this.origin.position.sub(this.point).applyQuaternion(this.turnBy).add(this.point);
    this.refresh();
  }

  /** Makes the user look along a direction of the scene. */
  face(direction: Vector3): void {
    const now = this.facing(this.point);
    this.turn(Math.atan2(direction.x, direction.z) - Math.atan2(now.x, now.z));
  }

  /** Sets the user's size, times life-size; the feet stay where they are. */
  resize(scale: number): void {
    this.feetAt(this.other);
    this.origin.scale.setScalar(clamp(scale));
    this.refresh();
    this.standAt(this.other.clone());
  }

  /** Puts the scene before the user as on a table, at 1:10. */
  asDollhouse(bounds: Box3): void {
    this.origin.scale.setScalar(DOLLHOUSE);
    this.refresh();
    const depth = bounds.isEmpty() ? 0 : Math.max(bounds.max.x - bounds.min.x, bounds.max.z - bounds.min.z) / DOLLHOUSE;
    const ahead = TABLE_GAP + 0.5 * Math.min(depth, 4);
    // The point of the table that the middle of the scene's floor comes to.
    const table = this.facing(new Vector3()).multiplyScalar(ahead * DOLLHOUSE).add(this.feetAt(this.point));
    table.y += TABLE_HEIGHT * DOLLHOUSE;
    const middle = bounds.isEmpty() ? new Vector3() : bounds.getCenter(new Vector3()).setY(Math.max(bounds.min.y, 0));
    this.moveBy(middle.sub(table));
  }

  /** Moves, turns and resizes so that two points of the room come to two points of the scene; the floor stays level. */
  fit(rooms: readonly [Vector3, Vector3], scenes: readonly [Vector3, Vector3]): void {
    const room = this.point.copy(rooms[1]).sub(rooms[0]);
    const scene = this.other.copy(scenes[1]).sub(scenes[0]);
    if (room.lengthSq() < 1e-4) return;
    this.origin.scale.setScalar(clamp(scene.length() / room.length()));
    // Hands above each other say nothing about the direction.
    if (Math.hypot(room.x, room.z) > 0.05) {
      const angle = Math.atan2(scene.x, scene.z) - Math.atan2(room.x, room.z);
      this.origin.quaternion.setFromAxisAngle(UP, angle);
    }
    this.origin.position.set(0, 0, 0);
    this.refresh();
    const middle = this.point.copy(rooms[0]).add(rooms[1]).multiplyScalar(0.5).applyMatrix4(this.origin.matrixWorld);
    this.moveBy(this.other.copy(scenes[0]).add(scenes[1]).multiplyScalar(0.5).sub(middle));
  }
}

function clamp(scale: number): number {
  return Math.min(Math.max(scale, SMALLEST), LARGEST);
}
