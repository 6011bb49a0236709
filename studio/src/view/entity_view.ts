// SPDX-License-Identifier: MIT
import { Box3, Color, Group, type Intersection, Matrix4, Quaternion, Raycaster, Vector3 } from "three";
import { type Motion } from "../document/motion";
import { type Changed, positionOf, rotationOf, type SceneDocument } from "../document/scene_document";
import type { Entity } from "../connection/scene_types";
import { Signal } from "../signal";
import type { Connection } from "../connection/connection";
import type { Frame } from "../connection/frame";
import { Batch } from "./batch";
import type { Viewer } from "./detail";
import { averageColor, disposeDrawable, disposeGeometries, type Drawable } from "./drawable";
import type { ModelStore } from "./model_store";
import { setFinish } from "./finish";
import { isOn } from "./lamps";
import { opticsOf } from "./liquid_look";
import { PointClouds } from "./point_clouds";
import { drawShape, shapeKey } from "./shapes";
import { SoftBodies } from "./soft_bodies";
import { type Quality, tintOf, type TintStrength } from "./tint";

const WHITE = new Color(1, 1, 1);
/** A lamp that is on shines by itself as far as its colour is above 1 (tint.ts). */
const GLOWING = new Color(1.9, 1.8, 1.6);
const STILL_COLOR = new Color(0.115, 0.12, 0.13);
/** Colour of grains without a colour of their own. */
const SAND = new Color(0.68, 0.5, 0.29);
/** Colour of drops of a liquid that has no surface. */
const DROPS = new Color(0.28, 0.5, 0.72);
/** Nearer things than this, m, are not more urgent to load. */
const NEAREST = 0.5;
/** The surface below a thing is looked for from so far over its base, and may be so far off, m. */
const ABOVE = 0.03;
const ROUGH = 0.005;
const DOWN = new Vector3(0, -1, 0);
const PLACEHOLDER = shapeDrawable({ index: 0, shape: { type: "box", half_extents: [0.15, 0.15, 0.15] } });

function shapeDrawable(entity: Entity): Drawable {
  const drawn = drawShape(entity.shape!);
  for (const { material } of drawn.parts) setFinish(material, entity.finish);
  return drawn;
}

/** Colours that are easy to tell apart: neighbours in the list differ in hue. */
export function colorOf(entity: Entity): Color {
  if (entity.model) return WHITE;
  if (entity.color) return new Color().setRGB(...entity.color);
  if (entity.shape?.type === "plane" || entity.shape?.type === "heightfield" || entity.shape?.type === "mesh") return STILL_COLOR;
  return new Color().setHSL((entity.index * 0.381966) % 1, 0.5, 0.45);
}

function drawnColor(entity: Entity): Color {
  const own = colorOf(entity);
  if (!isOn(entity.light)) return own;
  // Whatever its own colour is: the brightest part of a lamp's light is as bright.
  return own.clone().multiplyScalar(1 / Math.max(own.r, own.g, own.b, 0.1)).multiply(GLOWING);
}

/** Draws every entity of the document at its present pose. */
export class EntityView {
  readonly group = new Group();
  /** A model was loaded, or failed to load. */
  readonly loaded = new Signal<void>();
  /** The first of some models began to be loaded. */
  readonly loadingBegan = new Signal<void>();
  readonly failed = new Signal<{ index: number; reason: string }>();
  /** Surfaces of liquids cannot be computed; liquids are drawn as drops from now on. */
  readonly surfacesLost = new Signal<string>();
  /** An entity began or stopped to be drawn as points. */
  readonly pointed = new Signal<number>();
  tinted: TintStrength = "off";
  /** Poses and scales of entities while the user drags them; they replace the server's. */
  readonly held = new Map<number, { position: Vector3; rotation: Quaternion; scale: number }>();
  /** Things that stand at this height or higher are not drawn, m: of a building the storeys above. */
  private ceiling = Infinity;
  /** An entity was moved, added or removed since the shadows were drawn. */
  shadowsAreOld = true;
  /** Entities that were moved, added or removed since their contact shadows were drawn. */
  readonly shifted = new Set<number>();
  /** Points of entities that are not one body: grains, and nodes that carry a drawn form. */
  readonly clouds: PointClouds;
  readonly softs: SoftBodies;
  private readonly batches = new Map<string, Batch>();
  private readonly batchOf = new Map<number, { key: string; batch: Batch; entity: Entity }>();
  /** How often each entity is being loaded now: a soft one for its model and for its mesh. */
  private readonly pending = new Map<number, number>();
  /** Entities that were begun since nothing was loading. */
  private readonly begun = new Set<number>();
  /** Where the eye is: what is large or near is loaded first. */
  private readonly eye = new Vector3();

  private readonly position = new Vector3();
  private readonly rotation = new Quaternion();
  private readonly scale = new Vector3();
  private readonly downwards = new Raycaster();
  private readonly hits: Intersection[] = [];
  private readonly matrix = new Matrix4();

  constructor(
    private readonly document: SceneDocument,
    private readonly motion: Motion,
    private readonly models: ModelStore,
    private readonly connection: Connection,
    private quality: Quality,
  ) {
    this.softs = new SoftBodies(connection);
    this.clouds = new PointClouds(quality);
    this.group.add(this.clouds.group);
    this.clouds.lost.on(({ reason, indices }) => {
      for (const index of indices) this.dressCloud(index, 0);
      this.surfacesLost.emit(reason);
    });
    this.clouds.surfaced.on(() => {
      this.shadowsAreOld = true;
      this.loaded.emit();
    });
  }

  /** Number of entities that are being loaded. */
  get loading(): number {
    return this.pending.size;
  }

  /** Some entities are not yet drawn as they are: they are being loaded, or another mesh of theirs is. */
  get isSettling(): boolean {
    return this.loading > 0 || this.softs.isDressing;
  }

  /** How many of those that were begun since nothing was loading. */
  get loadingOf(): number {
    return this.begun.size;
  }

  lookFrom(eye: Vector3): void {
    this.eye.copy(eye);
  }

  apply(changed: Changed): void {
    if (changed.all) {
      for (const index of [...this.batchOf.keys()]) this.take(index);
      for (const index of this.known()) this.put(index);
      return;
    }
    for (const index of changed.removed) {
      this.take(index);
      this.clouds.drop(index);
      this.softs.drop(index);
    }
    for (const index of changed.entities) this.put(index);
  }

  /** Takes the points of a frame; an entity that has points is drawn as these. */
  takePoints(frame: Frame, now: number, smooth: boolean): void {
    if (frame.sets.length > 0) this.shadowsAreOld = true;
    for (const index of this.clouds.take(frame, now, smooth)) this.dressCloud(index, now);
    for (const index of this.softs.take(frame, now, smooth)) this.put(index);
  }

  /** The mesh that carries a soft entity's form has changed: a rope has broken. */
  redress(index: number): void {
    this.softs.age(index);
    this.put(index);
  }

  /** The world is as in the document: ropes are whole again. */
  mend(): void {
    for (const index of this.softs.broken()) this.redress(index);
  }

  /** All points belong to another scene: drops them. */
  forgetPoints(): void {
    this.clouds.clear();
    this.softs.clear();
  }

  /** Moves points towards their new positions; returns whether any are still moving. */
  advance(now: number): boolean {
    const cloudsMove = this.clouds.advance(now);
    return this.softs.advance(now, this.motion.moved) || cloudsMove;
  }

  /** Draws nothing that stands at this height or higher; Infinity: everything. */
  cutAbove(height: number): void {
    if (height === this.ceiling) return;
    this.ceiling = height;
    for (const index of this.known()) this.put(index);
    this.shadowsAreOld = true;
    this.loaded.emit();
  }

  setQuality(quality: Quality): void {
    this.quality = quality;
    this.clouds.setQuality(quality);
    for (const index of [...this.batchOf.keys()]) this.take(index);
    for (const index of this.known()) this.put(index);
  }

  /** Moves and tints the entities that changed since the last call. */
  update(now: number, everything = false): void {
    const moved = everything ? this.batchOf.keys() : this.motion.moved;
    if (everything || this.motion.moved.size > 0) this.shadowsAreOld = true;
    for (const index of moved) this.place(index, now);
    const restated = everything ? this.batchOf.keys() : this.motion.restated;
    for (const index of restated) this.tint(index);
    this.motion.moved.clear();
    this.motion.restated.clear();
  }

  /** Decides what of all this is in view of the next picture, and in which detail. */
  arrange(viewer: Viewer): void {
    for (const batch of this.batches.values()) batch.arrange(viewer);
  }

  /** The level of detail that an entity was last drawn in (0 is full), -1 where it was too small. */
  levelOf(index: number): number | undefined {
    return this.batchOf.get(index)?.batch.levelOf(index);
  }

  /** The surface below a point, within `reach` m and without one entity: its height, m, and whose it is; null: there is none. */
  below(point: Vector3, reach: number, ignore: number): { height: number; index: number } | null {
    this.downwards.set(this.position.copy(point).setY(point.y + ABOVE), DOWN);
    this.downwards.far = reach + ABOVE;
    this.hits.length = 0;
    for (const batch of this.batches.values()) batch.cast(this.downwards, this.hits, ROUGH, ignore);
    const [first] = this.hits.sort((a, b) => a.distance - b.distance);
    const index = first && (first.object.userData["batch"] as Batch).entityAt(first.instanceId!);
    return first && index !== undefined ? { height: first.point.y, index } : null;
  }

  /** The entity's frame as it is drawn now; false when it is not drawn. */
  matrixOf(index: number, now: number, matrix: Matrix4): boolean {
    const shown = this.batchOf.get(index);
    if (!shown) return false;
    const held = this.held.get(index);
    if (held) {
      matrix.compose(held.position, held.rotation, this.scale.setScalar(held.scale));
      return true;
    }
    if (!this.motion.pose(index, now, this.position, this.rotation)) return false;
    matrix.compose(this.position, this.rotation, this.scale.setScalar(shown.entity.scale ?? 1));
    return true;
  }

  drawableOf(index: number): Drawable | undefined {
    return this.batchOf.get(index)?.batch.drawable;
  }

  /** Red, green and blue of the state colour as it is drawn, and its amount. */
  tintOf(index: number): number[] {
    return this.clouds.of(index)?.tint() ?? this.batchOf.get(index)?.batch.tintOf(index) ?? [];
  }

  /** The box around the entities; infinite planes count as a point, a liquid without a drop as what it is to fill. Empty when none is drawn. */
  boundsOf(indices: Iterable<number>, now: number): Box3 {
    const bounds = new Box3();
    const matrix = new Matrix4();
    for (const index of indices) {
      const cloud = this.isEmpty(index) ? undefined : this.clouds.of(index);
      if (cloud) bounds.union(cloud.bounds);
      const shown = cloud ? undefined : this.batchOf.get(index);
      if (!shown || shown.entity.shape?.type === "plane" || !this.matrixOf(index, now, matrix)) continue;
      bounds.union(shown.batch.drawable.bounds.clone().applyMatrix4(matrix));
    }
    return bounds;
  }

  /** A liquid that has no drop now. */
  isEmpty(index: number): boolean {
    return this.clouds.of(index)?.count === 0;
  }

  private known(): Set<number> {
    return new Set([...this.document.entities.keys(), ...this.document.spawned.keys()]);
  }

  private put(index: number): void {
    const entity = this.document.entity(index);
    if (!entity) return;
    if (!this.motion.pose(index, 0, this.position, this.rotation))
      this.motion.place(index, positionOf(entity.pose), rotationOf(entity.pose));
    if (entity.enabled === false || positionOf(entity.pose)[1] >= this.ceiling || this.document.absent.has(index) || this.document.waiting.has(index)) {
      this.take(index);
      return;
    }
    if (this.softs.has(index)) void this.putSoft(entity);
    else if (entity.model) void this.putModel(entity, entity.model);
    else if (entity.shape) this.putShape(entity);
  }

  private putShape(entity: Entity): void {
    const key = `${entity.finish ?? "plain"} ${shapeKey(entity.shape!)}`;
    if (this.keep(entity, key)) return;
    try {
      this.join(entity, key, () => shapeDrawable(entity));
    } catch (error) {
      this.join(entity, "placeholder", () => PLACEHOLDER);
      this.failed.emit({ index: entity.index, reason: (error as Error).message });
    }
  }

  private async putModel(entity: Entity, key: string): Promise<void> {
    if (this.keep(entity, key)) return;
    this.begin(entity.index);
    try {
      const place = new Vector3(...positionOf(entity.pose));
      const drawable = await this.models.drawable(key, (size) => (size * (entity.scale ?? 1)) / Math.max(place.distanceTo(this.eye), NEAREST));
      // The entity may have been removed or changed while the model was being loaded.
      if (this.document.entity(entity.index) === entity) this.join(entity, key, () => drawable);
    } catch (error) {
      if (this.document.entity(entity.index) === entity) this.join(entity, "placeholder", () => PLACEHOLDER);
      this.failed.emit({ index: entity.index, reason: (error as Error).message });
    }
    this.end(entity.index);
  }

  private begin(index: number): void {
    // Told once the others of the same turn have begun, too.
    if (this.pending.size === 0) {
      this.begun.clear();
      queueMicrotask(() => this.loadingBegan.emit());
    }
    this.begun.add(index);
    this.pending.set(index, (this.pending.get(index) ?? 0) + 1);
  }

  private end(index: number): void {
    const left = (this.pending.get(index) ?? 1) - 1;
    if (left > 0) this.pending.set(index, left);
    else this.pending.delete(index);
    this.loaded.emit();
  }

  private async putSoft(entity: Entity): Promise<void> {
    const { index, model, scale } = entity;
    const key = `soft ${index} ${scale ?? 1} ${model ?? shapeKey(entity.shape!)}`;
    if (!this.softs.needsSkin(index) && this.keep(entity, key)) return;
    // What is drawn already stays until then.
    const isDrawn = this.softs.skinOf(index) !== null && this.batchOf.get(index)?.key === key;
    if (!isDrawn) this.begin(index);
    try {
      const plain = model ? this.models.drawable(model) : shapeDrawable(entity);
      const skin = await this.softs.dress(index, plain, scale ?? 1, this.quality);
      // The entity may have changed while the mesh was being loaded.
      if (skin && this.document.entity(index) === entity && this.softs.skinOf(index) === skin) {
        this.join(entity, key, () => skin.drawable);
        this.pointed.emit(index);
      } else if (skin) {
        this.discard(entity, skin.drawable);
      }
    } catch (error) {
      this.failed.emit({ index, reason: (error as Error).message });
    }
    if (isDrawn) this.loaded.emit();
    else this.end(index);
  }

  /** Keeps an entity that looks as before in its batch; false where it looks different. */
  private keep(entity: Entity, key: string): boolean {
    const shown = this.batchOf.get(entity.index);
    if (shown?.key !== key) return false;
    shown.entity = entity;
    shown.batch.setColor(entity.index, drawnColor(entity));
    this.colorCloud(entity.index);
    this.motion.moved.add(entity.index);
    return true;
  }

  private join(entity: Entity, key: string, make: () => Drawable): void {
    this.take(entity.index);
    let batch = this.batches.get(key);
    if (!batch) {
      batch = new Batch(make(), this.group, this.quality);
      this.batches.set(key, batch);
    }
    batch.add(entity.index, drawnColor(entity));
    this.batchOf.set(entity.index, { key, batch, entity });
    this.colorCloud(entity.index);
    // At once, not with the next picture: rays of the pointer meet it from now on.
    this.place(entity.index, performance.now());
    this.motion.moved.add(entity.index);
    this.motion.restated.add(entity.index);
  }

  private take(index: number): void {
    const shown = this.batchOf.get(index);
    if (!shown) return;
    this.batchOf.delete(index);
    this.shifted.add(index);
    this.shadowsAreOld = true;
    shown.batch.remove(index);
    if (!shown.batch.empty) return;
    shown.batch.dispose();
    this.batches.delete(shown.key);
    if (shown.key.startsWith("soft ") || !shown.entity.model) this.discard(shown.entity, shown.batch.drawable);
  }

  // Models stay in the store; all entities use the same placeholder.
  private discard(entity: Entity, drawable: Drawable): void {
    if (drawable === PLACEHOLDER) return;
    if (entity.model) disposeGeometries(drawable);
    else disposeDrawable(drawable);
  }

  /** An entity's points appeared, disappeared, or changed their kind: updates how it is drawn. */
  private dressCloud(index: number, now: number): void {
    this.colorCloud(index);
    this.tint(index);
    this.place(index, now);
    this.pointed.emit(index);
  }

  private colorCloud(index: number): void {
    const cloud = this.clouds.of(index);
    const shown = this.batchOf.get(index);
    if (!cloud || !shown) return;
    const { entity } = shown;
    if (cloud.isLiquid) {
      cloud.setColor(entity.color ? colorOf(entity) : null);
      void this.askOptics(index);
    } else if (entity.model) cloud.setColor(averageColor(shown.batch.drawable));
    else cloud.setColor(entity.color ? colorOf(entity) : cloud.isDrops ? DROPS : SAND);
  }

  private async askOptics(index: number): Promise<void> {
    try {
      const { attributes } = await this.connection.request("entity.attributes", { index });
      const cloud = this.clouds.of(index);
      if (cloud?.isLiquid) cloud.setOptics(opticsOf(attributes));
      this.loaded.emit();
    } catch (error) {
      this.failed.emit({ index, reason: (error as Error).message });
    }
  }

  private place(index: number, now: number): void {
    const isDrawn = this.matrixOf(index, now, this.matrix);
    if (this.softs.skinOf(index) && this.motion.pose(index, now, this.position, this.rotation))
      this.softs.bend(index, now, this.position, this.rotation, this.batchOf.get(index)?.entity.scale ?? 1);
    // An entity that is drawn as points is not drawn as the mesh that they filled.
    if (this.clouds.of(index)) this.matrix.makeScale(0, 0, 0);
    if (isDrawn) this.batchOf.get(index)!.batch.setMatrix(index, this.matrix);
    this.shifted.add(index);
  }

  private tint(index: number): void {
    const tint = tintOf(this.motion.state(index), this.tinted);
    this.batchOf.get(index)?.batch.setTint(index, tint);
    this.clouds.of(index)?.setTint(tint);
  }
}
