// SPDX-License-Identifier: MIT
import { Box3, Group, Matrix4, Mesh, MeshBasicMaterial, Quaternion, Vector3 } from "three";
import type { NewEntity } from "../connection/messages";
import { rotationOf } from "../document/scene_document";
import type { Parts } from "../parts";
import type { Drawable } from "../view/drawable";
import { drawShape } from "../view/shapes";

/** Distance from the eye at which entities are added where no surface is, m. */
const REACH = 5;
const FARTHEST_GROUND = 100;
/** Cosine of the steepest slope, 60°, that an entity is laid on. */
const STEEPEST_FLOOR = 0.5;
const UP = new Vector3(0, 1, 0);

/** Where a thing with this box about its origin lies on a surface: the place of its origin. */
export function restOn(bounds: Box3, point: Vector3, normal: Vector3, place: Vector3): Vector3 {
  place.copy(point);
  if (normal.y > STEEPEST_FLOOR) {
    place.y -= bounds.min.y;
    return place;
  }
  // At a wall or ceiling it is moved away from the surface by the depth that would be behind it.
  const half = bounds.getSize(new Vector3()).multiplyScalar(0.5);
  const reach = Math.abs(normal.x) * half.x + Math.abs(normal.y) * half.y + Math.abs(normal.z) * half.z;
  return place.addScaledVector(normal, reach).sub(bounds.getCenter(new Vector3()));
}

/** A half transparent preview of an entity on the surface under the pointer. The server places the real entity. */
export class Ghost {
  private readonly group = new Group();
  private readonly material = new MeshBasicMaterial({ color: 0x4fc3f7, transparent: true, opacity: 0.45, depthWrite: false });
  private drawable: Drawable | null = null;
  /** Box around the drawn entity, rotated as the entity will be. */
  private readonly bounds = new Box3();
  /** The same before it was turned by hand. */
  private readonly upright = new Box3();
  private readonly spin = new Matrix4();

  constructor(private readonly parts: Pick<Parts, "models" | "view">) {
    this.group.visible = false;
    parts.view.scene.add(this.group);
  }

  /** Starts with this entity; a model's ghost appears once the model is loaded. */
  async begin(entity: NewEntity): Promise<void> {
    this.end();
    const drawable = entity.model ? await this.parts.models.drawable(entity.model) : drawShape(entity.shape!);
    this.drawable = drawable;
    const turn = new Matrix4().makeRotationFromQuaternion(new Quaternion(...rotationOf(entity.pose)));
    this.upright.copy(drawable.bounds).applyMatrix4(turn);
    this.bounds.copy(this.upright);
    for (const part of drawable.parts) {
      const mesh = new Mesh(part.geometry, this.material);
      mesh.matrixAutoUpdate = false;
      mesh.matrix.multiplyMatrices(turn, part.matrix);
      this.group.add(mesh);
    }
  }

  /** Moves the ghost to the surface under the pointer. */
  moveTo(clientX: number, clientY: number): void {
    const { point, normal } = this.landing(clientX, clientY);
    this.lay(point, normal);
  }

  /** Moves the ghost to a point of a surface. */
  lay(point: Vector3, normal: Vector3): void {
    if (!this.drawable) return;
    restOn(this.bounds, point, normal, this.group.position);
    this.group.visible = true;
    this.parts.view.invalidate();
  }

  /** Turns the ghost about the vertical from how it began, rad. */
  turnTo(angle: number): void {
    if (this.group.rotation.y === angle || !this.drawable) return;
    this.group.rotation.y = angle;
    this.bounds.copy(this.upright).applyMatrix4(this.spin.makeRotationY(angle));
  }

  hide(): void {
    this.group.visible = false;
    this.parts.view.invalidate();
  }

  end(): void {
    this.group.clear();
    this.group.rotation.y = 0;
    this.drawable = null;
    this.hide();
  }

  private landing(clientX: number, clientY: number): { point: Vector3; normal: Vector3 } {
    const { view } = this.parts;
    const hit = view.pick(clientX, clientY);
    if (hit) return hit;
    const ground = view.meet(clientX, clientY);
    if (ground && ground.distanceTo(view.rig.camera.position) < FARTHEST_GROUND) return { point: ground, normal: UP };
    const { origin, direction } = view.ray(clientX, clientY);
    return { point: origin.addScaledVector(direction, REACH), normal: UP };
  }
}

/** Adds an entity where the ray through a point of the page meets the scene, and selects it. */
export async function addUnder(parts: Pick<Parts, "server" | "selection" | "view">, entity: NewEntity, clientX: number, clientY: number): Promise<void> {
  const { origin, direction } = parts.view.ray(clientX, clientY);
  const drop = { origin: origin.toArray(), direction: direction.toArray() };
  // A plane is infinite: it has a fixed pose and lies on nothing.
  const params = entity.shape?.type === "plane" ? { entity } : { entity, drop };
  const added = await parts.server.command("entity.add", params);
  if (added) parts.selection.set([added.index]);
}

/** Adds an entity in front of the camera. */
export async function addInFront(parts: Pick<Parts, "server" | "selection" | "view">, entity: NewEntity): Promise<void> {
  const frame = parts.view.canvas.getBoundingClientRect();
  await addUnder(parts, entity, frame.left + frame.width / 2, frame.top + 0.55 * frame.height);
}
