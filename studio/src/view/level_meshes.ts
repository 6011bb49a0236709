// SPDX-License-Identifier: MIT
import { BufferAttribute, BufferGeometry, DynamicDrawUsage, type Group, InstancedBufferAttribute, InstancedMesh, type Material, Matrix4, MeshBasicMaterial } from "three";
import type { Drawable, DrawablePart } from "./drawable";

type Mesh = InstancedMesh<BufferGeometry, Material | Material[]>;

/** What is known of each instance of a batch, one after the other. */
export interface Instances {
  matrices: Float32Array<ArrayBuffer>;
  colors: Float32Array<ArrayBuffer>;
  tints: Float32Array<ArrayBuffer>;
}

const own = new Matrix4();

/**
 * The meshes of one level of detail, one a part: which of a batch's instances they draw is told by `fill`. Parts that stand in the same
 * place share their instances' numbers.
 */
export class LevelMeshes {
  readonly meshes: Mesh[] = [];
  private readonly colors: InstancedBufferAttribute;
  private readonly tints: InstancedBufferAttribute;
  private readonly places: { matrix: Matrix4; attribute: InstancedBufferAttribute }[] = [];
  /** Instances in view; those behind them only cast shadows. */
  private inView = 0;
  private all = 0;

  constructor(
    drawable: Drawable,
    parts: readonly DrawablePart[],
    level: number,
    materials: readonly Material[],
    readonly capacity: number,
    private readonly group: Group,
  ) {
    this.colors = numbers(capacity, 3);
    this.tints = numbers(capacity, 4);
    parts.forEach((part, at) => {
      const index = level === 0 || !part.levels ? part.geometry.index : part.levels[level - 1]!;
      if (level > 0 && index === null) return;
      // The instanced attributes are part of the geometry, so each mesh has its own geometry around the shared buffers.
      const geometry = sharing(part.geometry);
      geometry.setIndex(index as BufferAttribute | null);
      geometry.setAttribute("tint", this.tints);
      const material = materials[at]!;
      const mesh: Mesh = new InstancedMesh<BufferGeometry, Material | Material[]>(geometry, material, 0);
      if (drawable.isCloth && material.transparent) drawNearestOnly(mesh, material);
      mesh.instanceMatrix = this.placesOf(part.matrix);
      mesh.instanceColor = this.colors;
      mesh.castShadow = drawable.castsShadow && !part.material.transparent;
      mesh.receiveShadow = true;
      mesh.frustumCulled = false;
      mesh.matrixAutoUpdate = mesh.matrixWorldAutoUpdate = false;
      mesh.visible = false;
      // Rays meet full detail, whatever is drawn (batch.ts).
      mesh.raycast = () => {};
      mesh.onBeforeRender = () => void (mesh.count = this.inView);
      mesh.onBeforeShadow = () => void (mesh.count = this.all);
      this.meshes.push(mesh);
      group.add(mesh);
    });
  }

  /** Draws the instances in `slots`, of which the first `inView` are in view and the others, up to `all`, only cast shadows. */
  fill(instances: Instances, slots: Int32Array, inView: number, all: number): void {
    this.inView = inView;
    this.all = all;
    for (const mesh of this.meshes) mesh.visible = all > 0;
    if (all === 0) return;
    for (let at = 0; at < all; ++at) {
      const slot = slots[at]!;
      for (const { matrix, attribute } of this.places) own.fromArray(instances.matrices, 16 * slot).multiply(matrix).toArray(attribute.array, 16 * at);
    }
    for (const { attribute } of this.places) renew(attribute, all);
    this.dye(instances, slots);
  }

  /** Takes over colours and tints alone. */
  dye(instances: Instances, slots: Int32Array): void {
    const { colors, tints } = instances;
    for (let at = 0; at < this.all; ++at) {
      const slot = slots[at]!;
      for (let k = 0; k < 3; ++k) this.colors.array[3 * at + k] = colors[3 * slot + k]!;
      for (let k = 0; k < 4; ++k) this.tints.array[4 * at + k] = tints[4 * slot + k]!;
    }
    renew(this.colors, this.all);
    renew(this.tints, this.all);
  }

  /** `alone`: nothing else is drawn with the parts' own buffers, so that they leave the graphics card, too. */
  dispose(alone: boolean): void {
    for (const mesh of this.meshes) {
      this.group.remove(mesh);
      if (!alone) detach(mesh.geometry);
      mesh.geometry.dispose();
      // Of two materials the first, which fills the depth buffer, is the mesh's own.
      if (Array.isArray(mesh.material)) mesh.material[0]!.dispose();
      mesh.dispose();
    }
  }

  private placesOf(matrix: Matrix4): InstancedBufferAttribute {
    let place = this.places.find((each) => each.matrix.equals(matrix));
    if (!place) {
      place = { matrix, attribute: numbers(this.capacity, 16) };
      this.places.push(place);
    }
    return place.attribute;
  }
}

function numbers(capacity: number, size: number): InstancedBufferAttribute {
  const attribute = new InstancedBufferAttribute(new Float32Array(capacity * size), size);
  attribute.setUsage(DynamicDrawUsage);
  return attribute;
}

/** The first `count` go to the graphics card. */
function renew(attribute: InstancedBufferAttribute, count: number): void {
  attribute.clearUpdateRanges();
  attribute.addUpdateRange(0, count * attribute.itemSize);
  attribute.needsUpdate = true;
}

/** Leaves shared buffers to the others: three.js would otherwise dispose of theirs, too. */
function detach(geometry: BufferGeometry): void {
  geometry.setIndex(null);
  for (const name of Object.keys(geometry.attributes)) if (name !== "tint") geometry.deleteAttribute(name);
}

/**
 * Of folds behind each other only the nearest is blended with what is behind the cloth: the cloth first fills the depth buffer alone.
 * Otherwise the order of the triangles would decide which of them hide each other.
 */
function drawNearestOnly(mesh: Mesh, material: Material): void {
  material.forceSinglePass = true;
  // Transparent, so that it is drawn in the same pass as the visible mesh, which comes second.
  const depth = new MeshBasicMaterial({ colorWrite: false, transparent: true, side: material.side, forceSinglePass: true });
  mesh.material = [depth, material];
  for (const which of [0, 1]) mesh.geometry.addGroup(0, Infinity, which);
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
