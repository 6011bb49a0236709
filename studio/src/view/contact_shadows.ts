// SPDX-License-Identifier: MIT
import { Box3, DataTexture, DynamicDrawUsage, InstancedBufferAttribute, InstancedMesh, LinearFilter, LinearMipmapLinearFilter, Matrix4, PlaneGeometry, RedFormat, ShaderMaterial, Vector3 } from "three";
import type { Drawable } from "./drawable";
import type { EntityView } from "./entity_view";
import { FOOTPRINT_SIDE, type Footprint, footprintOf } from "./footprint";
import type { Quality } from "./tint";

/** Footprints beside and below each other in one texture; models beyond these have no contact shadow. */
const TILES_A_SIDE = 24;
/** Things wider than this have none, m: floors, terrains, houses; nor have those that are so many times as long as wide. */
const WIDEST = 12;
const THINNEST = 15;
/** Over this gap to what is below a shadow fades out, m. */
const FADE = 0.7;
/** Shadows lie so high over what they fall on, m. */
const LIFT = 0.004;
/** Looking for what is below goes on for at most so long before a picture, ms; the rest waits for the next. */
const BUDGET_MS = 2;
/** Where more move at once than this, it is not looked for what stands on each: it moves, too. */
const MOST_CARRIERS = 32;
/** Of the darkening where a thing touches; in full drawing the sun's shadows do most of it. */
const STRENGTH: Record<Quality, number> = { low: 0.62, high: 0.34 };
/** A thing that is tilted more than this stands on something else than its base: cosine. */
const UPRIGHT = 0.95;

interface Shadow {
  slot: number;
  /** Where the thing stands, m. */
  x: number;
  z: number;
  /** Height of what is below, m, and the entity; null: nothing near. */
  ground: number | null;
  on: number | null;
}

/**
 * Soft shadows where things stand, one draw call for all: a flat picture for each model, drawn once from its triangles, on the surface
 * that is below the thing. They cost no second pass, so fast drawing has them, too.
 */
export class ContactShadows {
  readonly mesh: InstancedMesh<PlaneGeometry, ShaderMaterial>;
  private readonly texture: DataTexture;
  private readonly tiles = new Map<Drawable, { tile: number; footprint: Footprint }>();
  private readonly shadows = new Map<number, Shadow>();
  private readonly indices: number[] = [];
  private readonly unsettled = new Set<number>();
  private tileOf: InstancedBufferAttribute;
  private readonly matrix = new Matrix4();
  private readonly turn = new Matrix4();
  private readonly up = new Vector3();
  private readonly foot = new Vector3();
  private readonly bounds = new Box3();

  constructor(private readonly entities: EntityView) {
    const side = TILES_A_SIDE * FOOTPRINT_SIDE;
    this.texture = new DataTexture(new Uint8Array(side * side), side, side, RedFormat);
    this.texture.minFilter = LinearMipmapLinearFilter;
    this.texture.magFilter = LinearFilter;
    this.texture.generateMipmaps = true;
    const geometry = new PlaneGeometry(1, 1).rotateX(-Math.PI / 2).translate(0.5, 0, 0.5);
    this.mesh = new InstancedMesh(geometry, material(this.texture), 0);
    this.tileOf = this.reserve(64);
    this.mesh.frustumCulled = false;
    this.mesh.matrixAutoUpdate = false;
    this.mesh.renderOrder = -1;
    this.mesh.raycast = () => {};
  }

  /** Shadows that are drawn now. */
  get count(): number {
    return [...this.shadows.keys()].filter((index) => this.darknessOf(index) > 0).length;
  }

  /** How dark an entity's shadow is, 0 … 1. */
  darknessOf(index: number): number {
    const shadow = this.shadows.get(index);
    return shadow ? this.tileOf.getY(shadow.slot) : 0;
  }

  /** Height of an entity's shadow, m; null where it has none. */
  heightOf(index: number): number | null {
    return this.darknessOf(index) > 0 ? this.shadows.get(index)!.ground : null;
  }

  setQuality(quality: Quality): void {
    this.mesh.material.uniforms["strength"]!.value = STRENGTH[quality];
  }

  /** Follows what moved, appeared or went since the last picture; returns whether some wait for the next. */
  update(now: number): boolean {
    const { shifted } = this.entities;
    for (const index of shifted) {
      this.unsettled.add(index);
      if (shifted.size <= MOST_CARRIERS) this.unsettleOn(index, now);
    }
    shifted.clear();
    const end = performance.now() + BUDGET_MS;
    for (const index of this.unsettled) {
      this.unsettled.delete(index);
      this.settle(index, now);
      if (performance.now() > end) break;
    }
    return this.unsettled.size > 0;
  }

  /** What stands on an entity, or could now. */
  private unsettleOn(index: number, now: number): void {
    const drawable = this.entities.drawableOf(index);
    const isThere = drawable !== undefined && this.entities.matrixOf(index, now, this.matrix);
    if (isThere) this.bounds.copy(drawable.bounds).applyMatrix4(this.matrix);
    const { min, max } = this.bounds;
    for (const [other, { x, z, on }] of this.shadows)
      if (on === index || (isThere && x > min.x && x < max.x && z > min.z && z < max.z)) this.unsettled.add(other);
  }

  private settle(index: number, now: number): void {
    const drawable = this.entities.drawableOf(index);
    if (!drawable || !this.entities.matrixOf(index, now, this.matrix) || !castsContactShadow(drawable) || this.entities.clouds.of(index)) {
      this.drop(index);
      return;
    }
    const tile = this.tileFor(drawable);
    if (!tile) return;
    const shadow = this.shadows.get(index) ?? this.add(index);
    const { elements } = this.matrix;
    const scale = this.matrix.getMaxScaleOnAxis();
    this.up.set(elements[4]!, elements[5]!, elements[6]!).divideScalar(scale);
    const bounds = this.bounds.copy(drawable.bounds).applyMatrix4(this.matrix);
    const isUpright = this.up.y > UPRIGHT;
    bounds.getCenter(this.foot).setY(bounds.min.y);
    const below = this.entities.below(this.foot, FADE, index);
    [shadow.x, shadow.z] = [this.foot.x, this.foot.z];
    shadow.ground = below?.height ?? null;
    shadow.on = below?.index ?? null;
    const gap = shadow.ground === null ? FADE : bounds.min.y - shadow.ground;
    const darkness = Math.max(0, 1 - Math.max(0, gap) / FADE) ** 2;
    this.tileOf.setXY(shadow.slot, isUpright ? tile.tile : 0, darkness);
    this.tileOf.needsUpdate = true;
    const height = (shadow.ground ?? 0) + LIFT;
    const { footprint } = tile;
    if (isUpright) {
      // The picture lies about the entity's origin, turned with it about the vertical.
      const [x, z] = [elements[12]!, elements[14]!];
      this.turn.makeRotationY(Math.atan2(-elements[2]!, elements[0]!)).setPosition(x, height, z);
      this.matrix.makeScale(footprint.width * scale, 1, footprint.depth * scale).setPosition(footprint.left * scale, 0, footprint.back * scale);
      this.matrix.premultiply(this.turn);
    } else {
      this.matrix.makeScale(bounds.max.x - bounds.min.x, 1, bounds.max.z - bounds.min.z).setPosition(bounds.min.x, height, bounds.min.z);
    }
    this.mesh.setMatrixAt(shadow.slot, this.matrix);
    this.mesh.instanceMatrix.needsUpdate = true;
  }

  private add(index: number): Shadow {
    const slot = this.indices.length;
    if (slot === this.tileOf.count) {
      const { matrix, tiles } = { matrix: this.mesh.instanceMatrix.array, tiles: this.tileOf.array };
      this.tileOf = this.reserve(2 * slot);
      this.mesh.instanceMatrix.array.set(matrix);
      this.tileOf.array.set(tiles);
    }
    this.indices.push(index);
    const shadow = { slot, x: 0, z: 0, ground: null, on: null };
    this.shadows.set(index, shadow);
    this.mesh.count = this.indices.length;
    return shadow;
  }

  /** The last one moves into the free slot. */
  private drop(index: number): void {
    const shadow = this.shadows.get(index);
    if (!shadow) return;
    const last = this.indices.pop()!;
    this.shadows.delete(index);
    if (last !== index) {
      const { slot } = this.shadows.get(last)!;
      this.mesh.instanceMatrix.array.copyWithin(16 * shadow.slot, 16 * slot, 16 * slot + 16);
      this.tileOf.array.copyWithin(2 * shadow.slot, 2 * slot, 2 * slot + 2);
      this.shadows.get(last)!.slot = shadow.slot;
      this.indices[shadow.slot] = last;
    }
    this.mesh.count = this.indices.length;
    this.mesh.instanceMatrix.needsUpdate = this.tileOf.needsUpdate = true;
  }

  private reserve(capacity: number): InstancedBufferAttribute {
    const tiles = new InstancedBufferAttribute(new Float32Array(2 * capacity), 2).setUsage(DynamicDrawUsage);
    // A geometry keeps the attributes that it was first drawn with.
    this.mesh.geometry = this.mesh.geometry.clone();
    this.mesh.geometry.setAttribute("tile", tiles);
    this.mesh.instanceMatrix = new InstancedBufferAttribute(new Float32Array(16 * capacity), 16).setUsage(DynamicDrawUsage);
    return tiles as InstancedBufferAttribute;
  }

  /** Tile 0 is for what lies on its side: a soft square. */
  private tileFor(drawable: Drawable): { tile: number; footprint: Footprint } | null {
    const known = this.tiles.get(drawable);
    if (known) return known;
    if (this.tiles.size === 0) this.put(0, softSquare());
    const tile = 1 + this.tiles.size;
    if (tile >= TILES_A_SIDE * TILES_A_SIDE) return null;
    const made = { tile, footprint: footprintOf(drawable) };
    this.tiles.set(drawable, made);
    this.put(tile, made.footprint.pixels);
    return made;
  }

  private put(tile: number, pixels: Uint8Array): void {
    const across = TILES_A_SIDE * FOOTPRINT_SIDE;
    const first = Math.floor(tile / TILES_A_SIDE) * FOOTPRINT_SIDE * across + (tile % TILES_A_SIDE) * FOOTPRINT_SIDE;
    for (let row = 0; row < FOOTPRINT_SIDE; ++row)
      (this.texture.image.data as Uint8Array).set(pixels.subarray(row * FOOTPRINT_SIDE, (row + 1) * FOOTPRINT_SIDE), first + row * across);
    this.texture.needsUpdate = true;
  }
}

function castsContactShadow(drawable: Drawable): boolean {
  const { min, max } = drawable.bounds;
  const [width, depth] = [max.x - min.x, max.z - min.z];
  const longest = Math.max(width, depth);
  // A wall is thinner than a cell of its picture: its shadow would be a smear beyond its ends.
  return drawable.castsShadow && !drawable.bends && longest < WIDEST && Math.min(width, depth) > longest / THINNEST;
}

function softSquare(): Uint8Array {
  const side = FOOTPRINT_SIDE;
  const ramp = (cell: number) => Math.min(1, (4 * Math.min(cell, side - 1 - cell)) / side);
  return Uint8Array.from({ length: side * side }, (_, at) => 210 * ramp(at % side) * ramp(Math.floor(at / side)));
}

function material(map: DataTexture): ShaderMaterial {
  return new ShaderMaterial({
    transparent: true,
    depthWrite: false,
    polygonOffset: true,
    polygonOffsetFactor: -1,
    polygonOffsetUnits: -1,
    uniforms: { map: { value: map }, strength: { value: STRENGTH.low } },
    vertexShader: `
      attribute vec2 tile;
      varying vec2 vPlace;
      varying float vDarkness;
      void main() {
        vec2 corner = vec2(mod(tile.x, ${TILES_A_SIDE.toFixed(1)}), floor(tile.x / ${TILES_A_SIDE.toFixed(1)}));
        // Half a pixel inside, so that neighbours do not bleed in.
        vec2 inside = mix(vec2(${(0.5 / FOOTPRINT_SIDE).toFixed(6)}), vec2(${(1 - 0.5 / FOOTPRINT_SIDE).toFixed(6)}), position.xz);
        vPlace = (corner + inside) / ${TILES_A_SIDE.toFixed(1)};
        vDarkness = tile.y;
        gl_Position = projectionMatrix * modelViewMatrix * instanceMatrix * vec4(position, 1.0);
        // What casts nothing is not drawn at all.
        if (tile.y <= 0.0) gl_Position = vec4(0.0, 0.0, 2.0, 1.0);
      }`,
    fragmentShader: `
      uniform sampler2D map;
      uniform float strength;
      varying vec2 vPlace;
      varying float vDarkness;
      void main() {
        gl_FragColor = vec4(0.0, 0.0, 0.0, strength * vDarkness * texture2D(map, vPlace).r);
      }`,
  });
}
