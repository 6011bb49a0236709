// SPDX-License-Identifier: MIT
import { BufferGeometry, type Color, DoubleSide, DynamicDrawUsage, type Group, InstancedBufferAttribute, InstancedMesh, type Material, Matrix4, MeshBasicMaterial } from "three";
import type { Drawable } from "./drawable";
import { type Quality, tintable } from "./tint";

const placed = new Matrix4();

/** All entities that look the same, drawn with one call for each part. */
export class Batch {
  private meshes: InstancedMesh<BufferGeometry, Material | Material[]>[] = [];
  private readonly slots: number[] = [];
  private readonly slotOf = new Map<number, number>();
  private capacity = 0;

  constructor(
    readonly drawable: Drawable,
    private readonly group: Group,
    private readonly quality: Quality,
  ) {}

  get empty(): boolean {
    return this.slots.length === 0;
  }

  add(index: number, color: Color): void {
    if (this.slots.length === this.capacity) this.grow(Math.max(4, 2 * this.capacity));
    const slot = this.slots.length;
    this.slots.push(index);
    this.slotOf.set(index, slot);
    for (const mesh of this.meshes) mesh.count = this.slots.length;
    this.setColor(index, color);
    this.setTint(index, [0, 0, 0, 0]);
  }

  /** The last instance moves into the free slot. */
  remove(index: number): void {
    const slot = this.slotOf.get(index);
    if (slot === undefined) return;
    const last = this.slots.length - 1;
    for (const mesh of this.meshes) {
      for (const attribute of attributesOf(mesh)) {
        attribute.array.copyWithin(slot * attribute.itemSize, last * attribute.itemSize, (last + 1) * attribute.itemSize);
        attribute.needsUpdate = true;
      }
      mesh.count = last;
      mesh.boundingSphere = null;
    }
    this.slots[slot] = this.slots[last]!;
    this.slotOf.set(this.slots[slot]!, slot);
    this.slots.pop();
    this.slotOf.delete(index);
  }

  setMatrix(index: number, matrix: Matrix4): void {
    const slot = this.slotOf.get(index);
    if (slot === undefined) return;
    this.drawable.parts.forEach((part, at) => {
      const mesh = this.meshes[at]!;
      mesh.setMatrixAt(slot, placed.multiplyMatrices(matrix, part.matrix));
      mesh.instanceMatrix.needsUpdate = true;
      mesh.boundingSphere = null;
    });
  }

  setColor(index: number, color: Color): void {
    const slot = this.slotOf.get(index);
    if (slot === undefined) return;
    for (const mesh of this.meshes) {
      mesh.setColorAt(slot, color);
      mesh.instanceColor!.needsUpdate = true;
    }
  }

  setTint(index: number, tint: readonly number[]): void {
    const slot = this.slotOf.get(index);
    if (slot === undefined) return;
    for (const mesh of this.meshes) {
      const attribute = mesh.geometry.getAttribute("tint") as InstancedBufferAttribute;
      attribute.set(tint, slot * 4);
      attribute.needsUpdate = true;
    }
  }

  tintOf(index: number): number[] {
    const slot = this.slotOf.get(index);
    const tint = this.meshes[0]?.geometry.getAttribute("tint");
    return slot === undefined || !tint ? [] : [...tint.array.slice(slot * 4, slot * 4 + 4)];
  }

  /** The entity behind an instance that a ray met. */
  entityAt(instance: number): number | undefined {
    return this.slots[instance];
  }

  dispose(): void {
    for (const mesh of this.meshes) this.release(mesh);
    this.meshes = [];
  }

  private grow(capacity: number): void {
    const before = this.meshes;
    this.meshes = this.drawable.parts.map((part, at) => {
      // The instanced attributes are part of the geometry, so each batch has its own geometry around the shared buffers.
      const geometry = sharing(part.geometry);
      geometry.setAttribute("tint", new InstancedBufferAttribute(new Float32Array(capacity * 4), 4).setUsage(DynamicDrawUsage));
      const material = tintable(part.material, this.quality, !this.drawable.isCloth);
      if (this.drawable.hasTwoSides) material.side = DoubleSide;
      const mesh = new InstancedMesh<BufferGeometry, Material | Material[]>(geometry, material, capacity);
      if (this.drawable.isCloth && material.transparent) drawNearestOnly(mesh, material);
      mesh.instanceColor = new InstancedBufferAttribute(new Float32Array(capacity * 3).fill(1), 3);
      mesh.instanceMatrix.setUsage(DynamicDrawUsage);
      const old = before[at];
      if (old) {
        const kept = attributesOf(old);
        attributesOf(mesh).forEach((attribute, which) => attribute.array.set(kept[which]!.array));
        this.release(old);
      }
      mesh.count = this.slots.length;
      mesh.castShadow = this.drawable.castsShadow && !part.material.transparent;
      mesh.receiveShadow = true;
      // Bounds would have to be computed again in every step; whole batches are rarely out of view.
      mesh.frustumCulled = false;
      mesh.userData["batch"] = this;
      this.group.add(mesh);
      return mesh;
    });
    this.capacity = capacity;
  }

  private release(mesh: InstancedMesh): void {
    this.group.remove(mesh);
    mesh.geometry.dispose();
    for (const material of [mesh.material].flat()) material.dispose();
    mesh.dispose();
  }
}

/**
 * Of folds behind each other only the nearest is blended with what is behind the cloth: the cloth first fills the depth buffer alone.
 * Otherwise the order of the triangles would decide which of them hide each other.
 */
function drawNearestOnly(mesh: InstancedMesh<BufferGeometry, Material | Material[]>, material: Material): void {
  material.forceSinglePass = true;
  // Transparent, so that it is drawn in the same pass as the visible mesh, which comes second.
  const depth = new MeshBasicMaterial({ colorWrite: false, transparent: true, side: material.side, forceSinglePass: true });
  mesh.material = [depth, material];
  for (const which of [0, 1]) mesh.geometry.addGroup(0, Infinity, which);
}

function attributesOf(mesh: InstancedMesh): InstancedBufferAttribute[] {
  return [mesh.instanceMatrix, mesh.instanceColor!, mesh.geometry.getAttribute("tint") as InstancedBufferAttribute];
}

/** A geometry of its own around the same buffers. */
export function sharing(original: BufferGeometry): BufferGeometry {
  const geometry = new BufferGeometry();
  geometry.setIndex(original.index);
  for (const [name, attribute] of Object.entries(original.attributes)) geometry.setAttribute(name, attribute);
  geometry.groups = [...original.groups];
  geometry.boundingBox = original.boundingBox;
  geometry.boundingSphere = original.boundingSphere;
  return geometry;
}
