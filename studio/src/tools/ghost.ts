// SPDX-License-Identifier: MIT
import { Group, Mesh, MeshBasicMaterial, Vector3 } from "three";
import type { NewEntity } from "../connection/messages";
import type { Studio } from "../studio";
import type { Drawable } from "../view/drawable";
import { drawShape } from "../view/shapes";

/** Distance from the eye at which things arrive where no surface is, m. */
const REACH = 4;

/** What will be added lies, half transparent, on the surface under the pointer. The server places the real one. */
export class Ghost {
  private readonly group = new Group();
  private readonly material = new MeshBasicMaterial({ color: 0x4fc3f7, transparent: true, opacity: 0.45, depthWrite: false });
  private drawable: Drawable | null = null;

  constructor(private readonly studio: Studio) {
    this.group.visible = false;
    studio.view.scene.add(this.group);
  }

  /** Begins with this entity; a model's ghost appears when its picture is here. */
  async begin(entity: NewEntity): Promise<void> {
    this.end();
    const drawable = entity.model ? await this.studio.models.drawable(entity.model) : drawShape(entity.shape!);
    this.drawable = drawable;
    for (const part of drawable.parts) {
      const mesh = new Mesh(part.geometry, this.material);
      mesh.matrixAutoUpdate = false;
      mesh.matrix.copy(part.matrix);
      this.group.add(mesh);
    }
  }

  /** Lies on what is under the pointer. */
  moveTo(clientX: number, clientY: number): void {
    const { view } = this.studio;
    this.group.position.copy(this.landing(clientX, clientY));
    if (this.drawable) this.group.position.y -= this.drawable.bounds.min.y;
    this.group.visible = this.drawable !== null;
    view.invalidate();
  }

  hide(): void {
    this.group.visible = false;
    this.studio.view.invalidate();
  }

  end(): void {
    this.group.clear();
    this.drawable = null;
    this.hide();
  }

  private landing(clientX: number, clientY: number): Vector3 {
    const { view } = this.studio;
    const hit = view.pick(clientX, clientY);
    if (hit) return hit.point;
    const ground = view.meet(clientX, clientY);
    if (ground && ground.distanceTo(view.rig.camera.position) < 20 * view.rig.distance) return ground;
    const { origin, direction } = view.ray(clientX, clientY);
    return origin.addScaledVector(direction, REACH);
  }
}

/** Adds an entity where the ray through a point of the page meets the scene, and selects it. */
export async function addUnder(studio: Studio, entity: NewEntity, clientX: number, clientY: number): Promise<void> {
  const { origin, direction } = studio.view.ray(clientX, clientY);
  const drop = { origin: origin.toArray(), direction: direction.toArray() };
  const added = await studio.command("entity.add", { entity, drop });
  if (added) studio.selection.set([added.index]);
}

/** Adds an entity in front of the camera. */
export async function addInFront(studio: Studio, entity: NewEntity): Promise<void> {
  const frame = studio.view.canvas.getBoundingClientRect();
  await addUnder(studio, entity, frame.left + frame.width / 2, frame.top + 0.55 * frame.height);
}
