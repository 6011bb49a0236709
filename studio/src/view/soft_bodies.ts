// SPDX-License-Identifier: MIT
import { Matrix4, Quaternion, type Vector3 } from "three";
import type { Connection } from "../connection/connection";
import type { Frame, PointSet } from "../connection/frame";
import type { SimulationMesh } from "../connection/messages";
import type { Drawable } from "./drawable";
import type { Quality } from "./tint";
import { SoftForm, SoftSkin } from "./soft_form";
import { blend } from "../document/blend";

interface Nodes {
  from: Float32Array;
  to: Float32Array;
  now: Float32Array;
  /** Positions of the skin's nodes in the entity's frame. */
  local: Float32Array;
  start: number;
  duration: number;
  skin: SoftSkin | null;
  /** The skin's mesh is not the present one, and another was not asked for yet. */
  isOld: boolean;
  isBroken: boolean;
  /** The fewest and the most numbers that its mesh may have, as far as it is torn. */
  least: number;
  most: number;
}

/** Entities whose nodes carry their drawn form, and the nodes' positions. */
export class SoftBodies {
  private readonly all = new Map<number, Nodes>();
  private readonly moving = new Set<number>();
  /** Entities whose skins are being made. */
  private readonly dressing = new Set<number>();
  private lastFrame = 0;
  private readonly turn = new Matrix4();
  private readonly back = new Quaternion();

  constructor(private readonly connection: Connection) {}

  has(index: number): boolean {
    return this.all.has(index);
  }

  /** Present positions of the entity's nodes, world: x, y, z of each; null where it is not soft. */
  placesOf(index: number): Float32Array | null {
    return this.all.get(index)?.now ?? null;
  }

  skinOf(index: number): SoftSkin | null {
    return this.all.get(index)?.skin ?? null;
  }

  /** Some skins are being made. */
  get isDressing(): boolean {
    return this.dressing.size > 0;
  }

  /** Whether the entity has no skin of its present mesh (yet). */
  needsSkin(index: number): boolean {
    const nodes = this.all.get(index);
    return !nodes?.skin || nodes.isOld || this.dressing.has(index);
  }

  /** Takes a frame's nodes; returns the entities that became soft, are no longer soft, or have another mesh. */
  take(frame: Frame, now: number, smooth: boolean): number[] {
    const changed: number[] = [];
    frame.indices.forEach((index, record) => {
      if (!frame.pointed[record] && this.drop(index)) changed.push(index);
    });
    const duration = smooth ? Math.min(now - this.lastFrame, blend.longest) : 0;
    this.lastFrame = now;
    for (const set of frame.sets) {
      if (set.radius > 0) {
        if (this.drop(set.index)) changed.push(set.index);
        continue;
      }
      const nodes = this.all.get(set.index);
      if (nodes && goesOn(nodes, set)) {
        this.blend(nodes, now);
        move(nodes, set);
        nodes.start = now;
        nodes.duration = duration;
        // The answer to what was asked for is newer than this frame.
        if (nodes.isOld && !this.dressing.has(set.index)) changed.push(set.index);
      } else {
        this.all.set(set.index, nodesOf(set, now));
        changed.push(set.index);
      }
      this.moving.add(set.index);
    }
    return changed;
  }

  /** Adds the entities whose nodes are moving to `moved`; returns whether any still are afterwards. */
  advance(now: number, moved: Set<number>): boolean {
    for (const index of this.moving) {
      moved.add(index);
      const nodes = this.all.get(index);
      if (!nodes || now >= nodes.start + nodes.duration) this.moving.delete(index);
    }
    return this.moving.size > 0;
  }

  /**
   * A drawable that bends with the entity's nodes, made from its drawable at rest; the caller disposes of its geometries.
   * Null where the entity is not soft (any more), or where the mesh is not of the last frame: then the next one asks again.
   */
  async dress(index: number, plain: Drawable | Promise<Drawable>, scale: number, quality: Quality): Promise<SoftSkin | null> {
    const asking = this.all.get(index);
    if (asking) asking.isOld = false;
    this.dressing.add(index);
    try {
      const drawable = await plain;
      const points = this.all.get(index)?.to.length;
      const { mesh } = await this.connection.request("entity.simulation_mesh", { index, ...(points && { points: points / 3 }) });
      const nodes = this.all.get(index);
      return nodes && mesh ? this.wear(index, nodes, mesh, drawable, scale, quality) : null;
    } finally {
      this.dressing.delete(index);
    }
  }

  private wear(index: number, nodes: Nodes, mesh: SimulationMesh, plain: Drawable, scale: number, quality: Quality): SoftSkin | null {
    const form = new SoftForm(mesh, scale);
    const whole = form.origins ? 3 * form.origins.filter((origin, node) => origin === node).length : form.nodes.length;
    const { length } = nodes.to;
    nodes.isOld = length !== form.nodes.length;
    // Of a sheet that goes on tearing the mesh may be newer than the last frame.
    if (length > form.nodes.length || length < whole) return null;
    nodes.isBroken = (mesh.broken?.length ?? 0) > 0;
    nodes.least = whole;
    nodes.most = Math.max(nodes.most, form.nodes.length);
    nodes.local = new Float32Array(form.nodes.length);
    nodes.skin = new SoftSkin(form, plain, quality, nodes.skin);
    this.moving.add(index);
    return nodes.skin;
  }

  /** Ropes that were broken when their drawables were made. */
  broken(): number[] {
    return [...this.all].filter(([, nodes]) => nodes.isBroken).map(([index]) => index);
  }

  /** The entity's mesh has changed. */
  age(index: number): void {
    const nodes = this.all.get(index);
    if (nodes) nodes.isOld = true;
  }

  /** The entity has torn, so that it has more nodes from the next frame on. */
  tear(index: number, more: number): void {
    this.age(index);
    const nodes = this.all.get(index);
    if (nodes) nodes.most += 3 * more;
  }

  /** Bends the entity's skin to the present nodes, in the entity's frame at this pose. */
  bend(index: number, now: number, position: Vector3, rotation: Quaternion, scale: number): void {
    const nodes = this.all.get(index);
    if (!nodes?.skin) return;
    this.blend(nodes, now);
    const { now: places, local } = nodes;
    const turn = this.turn.makeRotationFromQuaternion(this.back.copy(rotation).invert()).elements;
    const { origins } = nodes.skin.form;
    for (let at = 0; at < local.length; at += 3) {
      if (at >= places.length) {
        // Not torn yet.
        local.copyWithin(at, 3 * origins![at / 3]!, 3 * origins![at / 3]! + 3);
        continue;
      }
      const x = (places[at]! - position.x) / scale;
      const y = (places[at + 1]! - position.y) / scale;
      const z = (places[at + 2]! - position.z) / scale;
      local[at] = turn[0]! * x + turn[4]! * y + turn[8]! * z;
      local[at + 1] = turn[1]! * x + turn[5]! * y + turn[9]! * z;
      local[at + 2] = turn[2]! * x + turn[6]! * y + turn[10]! * z;
    }
    nodes.skin.follow(local);
  }

  drop(index: number): boolean {
    this.moving.delete(index);
    return this.all.delete(index);
  }

  clear(): void {
    for (const index of [...this.all.keys()]) this.drop(index);
  }

  private blend(nodes: Nodes, now: number): void {
    const part = nodes.duration > 0 ? Math.min((now - nodes.start) / nodes.duration, 1) : 1;
    const { from, to, now: places } = nodes;
    for (let at = 0; at < places.length; ++at) places[at] = from[at]! + part * (to[at]! - from[at]!);
  }
}

function nodesOf(set: PointSet, now: number): Nodes {
  const places = placesOf(set, new Float32Array(set.positions.length));
  const { length } = places;
  return { from: places.slice(), to: places, now: places.slice(), local: places.slice(), start: now, duration: 0, skin: null, isOld: false, isBroken: false, least: length, most: length };
}

/** Whether these are the nodes of the same mesh, which may be torn further or less far. */
function goesOn({ to, skin, least, most }: Nodes, { positions: { length } }: PointSet): boolean {
  return to.length === length || (skin !== null && length >= least && length <= most);
}

function move(nodes: Nodes, set: PointSet): void {
  const { length } = set.positions;
  if (nodes.to.length === length) {
    nodes.from.set(nodes.now);
    placesOf(set, nodes.to);
    return;
  }
  nodes.isOld = true;
  nodes.to = placesOf(set, new Float32Array(length));
  nodes.from = nodes.to.slice();
  nodes.from.set(nodes.now.subarray(0, length));
  nodes.now = nodes.from.slice();
}

function placesOf(set: PointSet, places: Float32Array): Float32Array {
  for (let at = 0; at < places.length; ++at)
    places[at] = set.lower[at % 3]! + (set.size[at % 3]! * set.positions[at]!) / 65535;
  return places;
}
