// SPDX-License-Identifier: MIT
import { Matrix4, Quaternion, type Vector3 } from "three";
import type { Connection } from "../connection/connection";
import type { Frame, PointSet } from "../connection/frame";
import type { Drawable } from "./drawable";
import type { Quality } from "./tint";
import { SoftForm, SoftSkin } from "./soft_form";
import { blend } from "../document/blend";

interface Nodes {
  from: Float32Array;
  to: Float32Array;
  now: Float32Array;
  /** Positions in the entity's frame. */
  local: Float32Array;
  start: number;
  duration: number;
  skin: SoftSkin | null;
  isBroken: boolean;
}

/** Entities whose nodes carry their drawn form, and the nodes' positions. */
export class SoftBodies {
  private readonly all = new Map<number, Nodes>();
  private readonly moving = new Set<number>();
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
      let nodes = this.all.get(set.index);
      if (nodes?.to.length !== set.positions.length) {
        this.drop(set.index);
        const places = placesOf(set, new Float32Array(set.positions.length));
        nodes = { from: places.slice(), to: places, now: places.slice(), local: places.slice(), start: now, duration: 0, skin: null, isBroken: false };
        this.all.set(set.index, nodes);
        changed.push(set.index);
      } else {
        this.blend(nodes, now);
        nodes.from.set(nodes.now);
        placesOf(set, nodes.to);
        nodes.start = now;
        nodes.duration = duration;
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
   * Null where the entity is not soft (any more).
   */
  async dress(index: number, plain: Drawable, scale: number, quality: Quality): Promise<SoftSkin | null> {
    const { mesh } = await this.connection.request("entity.simulation_mesh", { index });
    const nodes = this.all.get(index);
    if (!mesh || nodes?.to.length !== mesh.nodes.length) return null;
    nodes.isBroken = (mesh.broken?.length ?? 0) > 0;
    nodes.skin = new SoftSkin(new SoftForm(mesh, scale), plain, quality);
    this.moving.add(index);
    return nodes.skin;
  }

  /** Ropes that were broken when their drawables were made. */
  broken(): number[] {
    return [...this.all].filter(([, nodes]) => nodes.isBroken).map(([index]) => index);
  }

  undress(index: number): void {
    const nodes = this.all.get(index);
    if (nodes) nodes.skin = null;
  }

  /** Bends the entity's skin to the present nodes, in the entity's frame at this pose. */
  bend(index: number, now: number, position: Vector3, rotation: Quaternion, scale: number): void {
    const nodes = this.all.get(index);
    if (!nodes?.skin) return;
    this.blend(nodes, now);
    const { now: places, local } = nodes;
    const turn = this.turn.makeRotationFromQuaternion(this.back.copy(rotation).invert()).elements;
    for (let at = 0; at < places.length; at += 3) {
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

function placesOf(set: PointSet, places: Float32Array): Float32Array {
  for (let at = 0; at < places.length; ++at)
    places[at] = set.lower[at % 3]! + (set.size[at % 3]! * set.positions[at]!) / 65535;
  return places;
}
