// SPDX-License-Identifier: MIT
import { Group, Mesh, MeshBasicMaterial, Quaternion, Vector3 } from "three";
import type { Drop, NewEntity } from "../connection/messages";
import type { Quaternion as Rotation } from "../connection/scene_types";
import { rotationOf } from "../document/scene_document";
import type { Parts } from "../parts";
import type { Drawable } from "../view/drawable";
import { drawShape } from "../view/shapes";
import { dropAt } from "./surface_drag";

const UP = new Vector3(0, 1, 0);

/** The entity turned about the vertical by an angle, rad. */
export function turned(entity: NewEntity, angle: number): NewEntity {
  if (angle === 0) return entity;
  const rotation = new Quaternion().setFromAxisAngle(UP, angle).multiply(new Quaternion(...rotationOf(entity.pose)));
  return { ...entity, pose: { ...entity.pose, rotation: rotation.toArray() as Rotation } };
}

/** A half transparent preview of an entity at the place where the server would put it. */
export class Ghost {
  private readonly group = new Group();
  private readonly material = new MeshBasicMaterial({ color: 0x4fc3f7, transparent: true, opacity: 0.45, depthWrite: false });
  private entity: NewEntity | null = null;
  private wanted: { drop: Drop; angle: number } | null = null;
  private asking = false;

  constructor(private readonly parts: Pick<Parts, "server" | "models" | "view">) {
    this.group.name = "ghost";
    this.group.visible = false;
    parts.view.scene.add(this.group);
  }

  /** Starts with this entity; a model's ghost appears once the model is loaded. */
  async begin(entity: NewEntity): Promise<void> {
    this.end();
    this.entity = entity;
    const drawable: Drawable = entity.model ? await this.parts.models.drawable(entity.model) : drawShape(entity.shape!);
    if (this.entity !== entity) return;
    for (const part of drawable.parts) {
      const mesh = new Mesh(part.geometry, this.material);
      mesh.matrixAutoUpdate = false;
      mesh.matrix.copy(part.matrix);
      this.group.add(mesh);
    }
    this.group.scale.setScalar(entity.scale ?? 1);
  }

  /** Asks where a drop here would end and shows that; at most one question is on its way. */
  moveTo(clientX: number, clientY: number): void {
    this.moveAlong(dropAt(this.parts, clientX, clientY), 0);
  }

  /** The same for a ray of the world, and a thing that was turned by an angle, rad. */
  moveAlong(drop: Drop, angle: number): void {
    // A plane is infinite: it has a fixed pose and lies on nothing.
    if (this.entity?.shape?.type === "plane") return;
    this.wanted = { drop, angle };
    if (!this.asking) void this.ask();
  }

  hide(): void {
    this.wanted = null;
    this.group.visible = false;
    this.parts.view.invalidate();
  }

  end(): void {
    this.group.clear();
    this.entity = null;
    this.hide();
  }

  private async ask(): Promise<void> {
    this.asking = true;
    while (this.wanted && this.entity) {
      const { entity, wanted } = this;
      this.wanted = null;
      const placed = await this.parts.server.command("entity.preview", { entity: turned(entity, wanted.angle), drop: wanted.drop });
      // It may have been dropped, or carried out of the scene.
      if (!placed || this.entity !== entity) break;
      this.group.position.set(...placed.pose.position);
      this.group.quaternion.set(...placed.pose.rotation);
      this.group.visible = true;
      this.parts.view.invalidate();
    }
    this.asking = false;
  }
}

/** Adds an entity where the ray through a point of the page meets the scene, and selects it. */
export async function addUnder(parts: Pick<Parts, "server" | "selection" | "view">, entity: NewEntity, clientX: number, clientY: number): Promise<void> {
  const drop = dropAt(parts, clientX, clientY);
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
