// SPDX-License-Identifier: MIT
import { type BufferGeometry, type Color, DoubleSide, type Group, type Intersection, type Material, Matrix4, Mesh, Object3D, type Raycaster, Sphere, Vector3 } from "three";
import { NOTHING, type Viewer } from "./detail";
import { coarseIndexOf, type Drawable, type DrawablePart } from "./drawable";
import { type Instances, LevelMeshes, sharing } from "./level_meshes";
import { type Quality, tintable } from "./tint";

/** An instance before its first arrangement. */
const UNKNOWN = -2;
const NO_ERRORS: readonly number[] = [];

const placed = new Matrix4();
const ball = new Sphere();
const center = new Vector3();
const probe = new Mesh<BufferGeometry, Material>();
const found: Intersection[] = [];

/** All entities that look the same, drawn with one call for each part and level of detail that is in view. */
export class Batch {
  private readonly levels: (LevelMeshes | null)[];
  private readonly materials: Material[];
  private readonly farMaterials: Material[];
  private readonly slots: number[] = [];
  private readonly slotOf = new Map<number, number>();
  private instances: Instances = { matrices: new Float32Array(0), colors: new Float32Array(0), tints: new Float32Array(0) };
  /** Centre, radius and scale of each instance; the scale is 0 where it has no place yet. */
  private balls = new Float32Array(0);
  private drawnLevel = new Int8Array(0);
  private isInView = new Uint8Array(0);
  /** Slots of the level that is being filled; one list a level. */
  private orders: Int32Array[] = [];
  /** Geometries for rays that need no full detail; never drawn. */
  private readonly rough: BufferGeometry[] = [];
  private capacity = 0;
  private placesAreOld = false;
  private colorsAreOld = false;
  private hadShadows = false;
  private readonly target: Target;
  private readonly ownCenter = new Vector3();
  private ownRadius = Infinity;

  constructor(
    readonly drawable: Drawable,
    private readonly group: Group,
    quality: Quality,
  ) {
    this.levels = new Array<null>(1 + this.errors.length).fill(null);
    const dressed = (part: DrawablePart) => {
      const material = tintable(part.material, quality, !drawable.isCloth);
      if (drawable.hasTwoSides) material.side = DoubleSide;
      return material;
    };
    this.materials = drawable.parts.map(dressed);
    this.farMaterials = drawable.far?.parts.map(dressed) ?? [];
    this.measure();
    this.target = new Target(this);
    group.add(this.target);
  }

  get empty(): boolean {
    return this.slots.length === 0;
  }

  private get errors(): readonly number[] {
    return this.drawable.levelErrors ?? NO_ERRORS;
  }

  add(index: number, color: Color): void {
    if (this.slots.length === this.capacity) this.grow(Math.max(4, 2 * this.capacity));
    const slot = this.slots.length;
    this.slots.push(index);
    this.slotOf.set(index, slot);
    this.drawnLevel[slot] = UNKNOWN;
    this.balls.fill(0, 5 * slot, 5 * slot + 5);
    this.instances.matrices.fill(0, 16 * slot, 16 * slot + 16);
    this.setColor(index, color);
    this.setTint(index, [0, 0, 0, 0]);
    this.placesAreOld = true;
  }

  /** The last instance moves into the free slot. */
  remove(index: number): void {
    const slot = this.slotOf.get(index);
    if (slot === undefined) return;
    const last = this.slots.length - 1;
    const { matrices, colors, tints } = this.instances;
    for (const [array, size] of [[matrices, 16], [colors, 3], [tints, 4], [this.balls, 5], [this.drawnLevel, 1], [this.isInView, 1]] as const)
      array.copyWithin(slot * size, last * size, (last + 1) * size);
    this.slots[slot] = this.slots[last]!;
    this.slotOf.set(this.slots[slot]!, slot);
    this.slots.pop();
    this.slotOf.delete(index);
    this.placesAreOld = true;
  }

  setMatrix(index: number, matrix: Matrix4): void {
    const slot = this.slotOf.get(index);
    if (slot === undefined) return;
    matrix.toArray(this.instances.matrices, 16 * slot);
    if (this.drawable.bends) this.measure();
    center.copy(this.ownCenter).applyMatrix4(matrix);
    const scale = matrix.getMaxScaleOnAxis();
    const { balls } = this;
    balls[5 * slot] = center.x;
    balls[5 * slot + 1] = center.y;
    balls[5 * slot + 2] = center.z;
    balls[5 * slot + 3] = this.ownRadius * scale;
    balls[5 * slot + 4] = scale;
    this.placesAreOld = true;
  }

  setColor(index: number, color: Color): void {
    const slot = this.slotOf.get(index);
    if (slot === undefined) return;
    color.toArray(this.instances.colors, 3 * slot);
    this.colorsAreOld = true;
  }

  setTint(index: number, tint: readonly number[]): void {
    const slot = this.slotOf.get(index);
    if (slot === undefined) return;
    this.instances.tints.set(tint, 4 * slot);
    this.colorsAreOld = true;
  }

  tintOf(index: number): number[] {
    const slot = this.slotOf.get(index);
    return slot === undefined ? [] : [...this.instances.tints.slice(slot * 4, slot * 4 + 4)];
  }

  /** The level of detail that an entity was last drawn in; NOTHING where it was too small, undefined where it is not here. */
  levelOf(index: number): number | undefined {
    const slot = this.slotOf.get(index);
    return slot === undefined ? undefined : this.drawnLevel[slot];
  }

  /** The entity behind an instance that a ray met. */
  entityAt(instance: number): number | undefined {
    return this.slots[instance];
  }

  /** Decides what is drawn, and in which detail, and takes over what has changed since the last picture. */
  arrange(viewer: Viewer): void {
    let changed = this.placesAreOld || this.hadShadows !== viewer.hasShadows;
    this.hadShadows = viewer.hasShadows;
    const { balls, drawnLevel, isInView } = this;
    for (let slot = 0; slot < this.slots.length; ++slot) {
      const at = 5 * slot;
      let level = NOTHING;
      let seen = 0;
      // What has no place yet is not drawn; what has no size is drawn as something else.
      if (balls[at + 4]! > 0) {
        seen = viewer.sees(balls, at) ? 1 : 0;
        if (seen || viewer.hasShadows) level = viewer.levelFor(balls, at, this.errors, drawnLevel[slot]!);
      }
      if (level === drawnLevel[slot] && seen === isInView[slot]) continue;
      drawnLevel[slot] = level;
      isInView[slot] = seen;
      changed = true;
    }
    if (changed) this.fill();
    else if (this.colorsAreOld) for (let level = 0; level < this.levels.length; ++level) this.levels[level]?.dye(this.instances, this.orders[level]!);
    this.placesAreOld = this.colorsAreOld = false;
  }

  /** All instances that a ray meets, but one entity's, in full detail or within `error`, m. */
  cast(raycaster: Raycaster, hits: Intersection[], error = 0, ignore = -1): void {
    for (let slot = 0; slot < this.slots.length; ++slot) {
      if (this.slots[slot] === ignore) continue;
      const at = 5 * slot;
      const { balls } = this;
      if (!(balls[at + 4]! > 0)) continue;
      ball.set(center.set(balls[at]!, balls[at + 1]!, balls[at + 2]!), balls[at + 3]!);
      if (ball.radius < Infinity && !raycaster.ray.intersectsSphere(ball)) continue;
      placed.fromArray(this.instances.matrices, 16 * slot);
      this.drawable.parts.forEach((part, which) => {
        probe.geometry = error > 0 ? this.coarse(which, error / balls[at + 4]!) : part.geometry;
        probe.material = this.materials[which]!;
        probe.matrixWorld.multiplyMatrices(placed, part.matrix);
        probe.raycast(raycaster, found);
        for (const hit of found) {
          hit.normal = (hit.face?.normal ?? center.set(0, 1, 0)).clone().transformDirection(probe.matrixWorld);
          hits.push({ ...hit, object: this.target, instanceId: slot });
        }
        found.length = 0;
      });
    }
  }

  dispose(): void {
    for (const level of this.levels) level?.dispose(true);
    for (const material of [...this.materials, ...this.farMaterials]) material.dispose();
    this.group.remove(this.target);
  }

  /** The ball around what is drawn, in its own frame: of what bends it is another each time. */
  private measure(): void {
    const { bounds, castsShadow } = this.drawable;
    bounds.getCenter(this.ownCenter);
    this.ownRadius = castsShadow && !bounds.isEmpty() ? bounds.getSize(center).length() / 2 : Infinity;
  }

  private coarse(which: number, error: number): BufferGeometry {
    const part = this.drawable.parts[which]!;
    const index = coarseIndexOf(this.drawable, part, error);
    if (index === part.geometry.index) return part.geometry;
    const geometry = (this.rough[which] ??= sharing(part.geometry));
    geometry.setIndex(index);
    return geometry;
  }

  private fill(): void {
    for (let level = 0; level < this.levels.length; ++level) {
      let inView = 0;
      let all = 0;
      const order = this.orders[level]!;
      for (const seen of [1, 0]) {
        for (let slot = 0; slot < this.slots.length; ++slot) if (this.drawnLevel[slot] === level && this.isInView[slot] === seen) order[all++] = slot;
        if (seen) inView = all;
      }
      if (all > 0) this.levels[level] ??= this.meshesOf(level);
      this.levels[level]?.fill(this.instances, order, inView, all);
    }
  }

  private meshesOf(level: number): LevelMeshes {
    const { drawable } = this;
    const isFar = drawable.far !== undefined && level >= drawable.far.from;
    return new LevelMeshes(drawable, isFar ? drawable.far!.parts : drawable.parts, level, isFar ? this.farMaterials : this.materials, this.capacity, this.group);
  }

  private grow(capacity: number): void {
    const { matrices, colors, tints } = this.instances;
    this.instances = { matrices: longer(matrices, 16 * capacity), colors: longer(colors, 3 * capacity), tints: longer(tints, 4 * capacity) };
    this.balls = longer(this.balls, 5 * capacity);
    const levels = new Int8Array(capacity);
    levels.set(this.drawnLevel);
    this.drawnLevel = levels;
    const inView = new Uint8Array(capacity);
    inView.set(this.isInView);
    this.isInView = inView;
    this.orders = this.levels.map(() => new Int32Array(capacity));
    for (const level of this.levels) level?.dispose(false);
    this.levels.fill(null);
    this.capacity = capacity;
    this.placesAreOld = true;
  }
}

function longer(array: Float32Array<ArrayBuffer>, length: number): Float32Array<ArrayBuffer> {
  const result = new Float32Array(length);
  result.set(array);
  return result;
}

/** What rays meet in place of a batch's meshes, which have fewer triangles and not all instances. */
class Target extends Object3D {
  constructor(private readonly batch: Batch) {
    super();
    this.userData["batch"] = batch;
    this.matrixAutoUpdate = this.matrixWorldAutoUpdate = false;
  }

  override raycast(raycaster: Raycaster, hits: Intersection[]): void {
    this.batch.cast(raycaster, hits);
  }
}
