// SPDX-License-Identifier: MIT
import { Box3, BufferAttribute, BufferGeometry, DynamicDrawUsage, Matrix4, Matrix3, Quaternion, Vector3 } from "three";
import type { SimulationMesh } from "../connection/messages";
import type { Drawable, DrawablePart } from "./drawable";
import { refine } from "./refine";

const NONE = new Matrix4();
/** Of an element's edge: how long drawn edges of cloth and ropes may be, so that they look round between the nodes. */
const THIN_SHARE = 0.7;

/** Which nodes an element has: four of a solid, three of cloth, two of a rope. */
function elementsOf(mesh: SimulationMesh): { corners: number; elements: number[] } {
  if (mesh.tetrahedra) return { corners: 4, elements: mesh.tetrahedra };
  if (mesh.triangles) return { corners: 3, elements: mesh.triangles };
  const elements: number[] = [];
  for (let node = 0; node + 1 < mesh.nodes.length / 3; ++node) if (!mesh.broken?.includes(node)) elements.push(node, node + 1);
  return { corners: 2, elements };
}

/**
 * Elements at rest, and how their nodes have turned and stretched what is around them, in the drawn thing's own frame. Each has three
 * directions that go along with it: a solid's edges; those of cloth and its unit normal; a rope's edge and two across it, which turn
 * with the rope but not about it.
 */
export class SoftForm {
  readonly nodes: Float32Array;
  readonly elements: Uint32Array;
  /** Nodes of an element. */
  readonly corners: number;
  /** Mean length of the edges, m. */
  readonly edge: number;
  /** Of each node nine numbers by rows: the deformation around it, the mean of its elements' by their amount. */
  readonly deformation: Float32Array;
  /** Of each element nine numbers by rows: what takes a place beside its first node to shares of its directions at rest. */
  private readonly inverse: Float32Array;
  private readonly amount: Float32Array;
  private readonly share: Float32Array;

  /** `scale`: of the entity; the mesh has it in its nodes. */
  constructor(mesh: SimulationMesh, scale: number) {
    const { corners, elements } = elementsOf(mesh);
    this.nodes = Float32Array.from(mesh.nodes, (number) => number / scale);
    this.elements = Uint32Array.from(elements);
    this.corners = corners;
    const count = this.count;
    this.inverse = new Float32Array(9 * count);
    this.amount = new Float32Array(count);
    this.share = new Float32Array(this.nodes.length / 3);
    this.deformation = new Float32Array(3 * this.nodes.length);
    const matrix = new Matrix3();
    const [e, f, g] = [new Vector3(), new Vector3(), new Vector3()];
    const frame = new RopeFrame();
    let lengths = 0;
    for (let t = 0; t < count; ++t) {
      this.directions(t, this.nodes, frame, e, f, g);
      lengths += e.length();
      matrix.set(e.x, f.x, g.x, e.y, f.y, g.y, e.z, f.z, g.z);
      this.amount[t] = Math.abs(matrix.determinant());
      this.inverse.set(matrix.invert().transpose().elements, 9 * t);
      for (let k = 0; k < corners; ++k) this.share[this.elements[corners * t + k]!]! += this.amount[t]!;
    }
    this.edge = count > 0 ? lengths / count : 1;
  }

  get count(): number {
    return this.elements.length / this.corners;
  }

  /** Weights of the nodes at a place: some are negative outside. */
  weightsAt(t: number, x: number, y: number, z: number, weights: Float32Array): void {
    const at = 3 * this.elements[this.corners * t]!;
    const m = this.inverse;
    const i = 9 * t;
    const [dx, dy, dz] = [x - this.nodes[at]!, y - this.nodes[at + 1]!, z - this.nodes[at + 2]!];
    weights[0] = 1;
    for (let k = 0; k + 1 < this.corners; ++k) {
      weights[k + 1] = m[i + 3 * k]! * dx + m[i + 3 * k + 1]! * dy + m[i + 3 * k + 2]! * dz;
      weights[0]! -= weights[k + 1]!;
    }
  }

  /** Finds the deformation with the nodes at these places (x, y, z each). */
  deform(places: Float32Array): void {
    const { deformation, elements, inverse, corners } = this;
    deformation.fill(0);
    const [e, f, g] = [new Vector3(), new Vector3(), new Vector3()];
    const columns = [0, 1, 2];
    const frame = new RopeFrame();
    for (let t = 0, i = 0; t < this.count; ++t, i += 9) {
      this.directions(t, places, frame, e, f, g);
      const amount = this.amount[t]!;
      const moved = [e.x, f.x, g.x, e.y, f.y, g.y, e.z, f.z, g.z];
      for (let at = 0; at < 9; at += 3)
        for (const column of columns) {
          const value =
            amount * (moved[at]! * inverse[i + column]! + moved[at + 1]! * inverse[i + 3 + column]! + moved[at + 2]! * inverse[i + 6 + column]!);
          for (let k = 0; k < corners; ++k) deformation[9 * elements[corners * t + k]! + at + column]! += value;
        }
    }
    for (let node = 0; node < this.share.length; ++node)
      for (let k = 9 * node; k < 9 * node + 9; ++k) deformation[k]! /= this.share[node]! || 1;
  }

  /** An element's three directions with the nodes at these places; of a rope they follow from those of the element before. */
  private directions(t: number, places: Float32Array, frame: RopeFrame, e: Vector3, f: Vector3, g: Vector3): void {
    const { elements, corners } = this;
    const at = (k: number) => 3 * elements[corners * t + k]!;
    const between = (k: number, to: Vector3) =>
      to.set(places[at(k)]! - places[at(0)]!, places[at(k) + 1]! - places[at(0) + 1]!, places[at(k) + 2]! - places[at(0) + 2]!);
    between(1, e);
    if (corners === 2) {
      frame.follow(e, f, g);
      return;
    }
    between(2, f);
    if (corners === 3) g.crossVectors(e, f).normalize();
    else between(3, g);
  }
}

/** Two directions across a line that goes on along edges: each turned as little as it can be from those before. */
class RopeFrame {
  private readonly tangent = new Vector3();
  private readonly across = new Vector3();
  private readonly now = new Vector3();
  private readonly turn = new Quaternion();

  follow(edge: Vector3, f: Vector3, g: Vector3): void {
    this.now.copy(edge).normalize();
    if (this.tangent.lengthSq() === 0) {
      this.across.set(Math.abs(this.now.y) < 0.9 ? 0 : 1, Math.abs(this.now.y) < 0.9 ? 1 : 0, 0);
    } else {
      this.across.applyQuaternion(this.turn.setFromUnitVectors(this.tangent, this.now));
    }
    this.across.addScaledVector(this.now, -this.across.dot(this.now)).normalize();
    this.tangent.copy(this.now);
    f.copy(this.across);
    g.crossVectors(this.now, f);
  }
}

/** Finds the element around a place, or the nearest one. */
class ElementFinder {
  private readonly cells = new Map<number, number[]>();
  private readonly box = new Box3();
  private readonly size: [number, number, number];
  private readonly own = new Float32Array(4);
  private readonly best = new Float32Array(4);

  constructor(private readonly form: SoftForm) {
    this.box.setFromArray(form.nodes);
    const extent = this.box.getSize(new Vector3());
    this.size = [0, 1, 2].map((axis) => Math.floor(extent.getComponent(axis) / form.edge) + 1) as [number, number, number];
    const around = new Box3();
    const corner = new Vector3();
    for (let t = 0; t < form.count; ++t) {
      around.makeEmpty();
      for (let k = 0; k < form.corners; ++k) around.expandByPoint(corner.fromArray(form.nodes, 3 * form.elements[form.corners * t + k]!));
      const low = this.cellOf(around.min.x, around.min.y, around.min.z);
      const high = this.cellOf(around.max.x, around.max.y, around.max.z);
      this.visit(low, high, (cell) => {
        const list = this.cells.get(cell);
        if (list) list.push(t);
        else this.cells.set(cell, [t]);
      });
    }
  }

  /** Which, and the weights of its nodes at the place of it that is nearest; none negative. */
  find(x: number, y: number, z: number, weights: Float32Array): number {
    const middle = this.cellOf(x, y, z);
    let found = -1;
    let least = Infinity;
    const farthest = Math.max(...this.size);
    for (let ring = 0; ring <= farthest && !(least <= (ring - 1) * this.form.edge); ++ring) {
      const low = middle.map((c) => Math.max(0, c - ring));
      const high = middle.map((c, axis) => Math.min(this.size[axis]! - 1, c + ring));
      this.visit(low, high, (cell, i, j, k) => {
        if (Math.max(Math.abs(i - middle[0]!), Math.abs(j - middle[1]!), Math.abs(k - middle[2]!)) !== ring) return;
        for (const t of this.cells.get(cell) ?? []) {
          const distance = this.distanceTo(t, x, y, z);
          if (distance >= least) continue;
          least = distance;
          found = t;
          this.best.set(this.own);
        }
      });
    }
    weights.set(this.best);
    return found;
  }

  /** To the place with the weights cut off at zero: 0 inside a solid. Leaves these in `own`. */
  private distanceTo(t: number, x: number, y: number, z: number): number {
    const { nodes, elements, corners } = this.form;
    this.form.weightsAt(t, x, y, z, this.own);
    if (corners === 4 && this.own.every((weight) => weight >= 0)) return 0;
    let sum = 0;
    for (let k = 0; k < corners; ++k) sum += this.own[k] = Math.max(0, this.own[k]!);
    let [dx, dy, dz] = [x, y, z];
    for (let k = 0; k < corners; ++k) {
      const at = 3 * elements[corners * t + k]!;
      const weight = (this.own[k]! /= sum);
      dx -= weight * nodes[at]!;
      dy -= weight * nodes[at + 1]!;
      dz -= weight * nodes[at + 2]!;
    }
    return Math.hypot(dx, dy, dz);
  }

  private cellOf(x: number, y: number, z: number): number[] {
    return [x, y, z].map((value, axis) => {
      const cell = Math.floor((value - this.box.min.getComponent(axis)) / this.form.edge);
      return Math.min(Math.max(cell, 0), this.size[axis]! - 1);
    });
  }

  private visit(low: number[], high: number[], each: (cell: number, i: number, j: number, k: number) => void): void {
    for (let i = low[0]!; i <= high[0]!; ++i)
      for (let j = low[1]!; j <= high[1]!; ++j)
        for (let k = low[2]!; k <= high[2]!; ++k) each((i * this.size[1] + j) * this.size[2] + k, i, j, k);
  }
}

/** Of each element a number: another one on either side of where a rope is broken. */
function piecesOf(form: SoftForm): Uint32Array {
  const pieces = new Uint32Array(form.count);
  if (form.corners > 2) return pieces;
  for (let t = 1; t < form.count; ++t) pieces[t] = pieces[t - 1]! + (form.elements[2 * t] === form.elements[2 * t - 1] ? 0 : 1);
  return pieces;
}

/** Takes out the triangles that would join different pieces. */
function cutBetween(geometry: BufferGeometry, pieces: Uint32Array): void {
  const index = geometry.index!.array;
  const kept: number[] = [];
  for (let at = 0; at < index.length; at += 3) {
    const [a, b, c] = [index[at]!, index[at + 1]!, index[at + 2]!];
    if (pieces[a] === pieces[b] && pieces[b] === pieces[c]) kept.push(a, b, c);
  }
  if (kept.length < index.length) geometry.setIndex(kept);
}

/** A drawn part whose vertices are carried by the elements: each by the nodes of one, and by the deformation there for what lies outside. */
class CarriedPart {
  private readonly nodes: Uint32Array;
  private readonly weights: Float32Array;
  private readonly offsets: Float32Array;
  /** Where the elements' nodes with their weights are at rest: a vertex is an offset away. */
  private readonly anchors: Float32Array;
  private readonly normals: Float32Array;
  private readonly position: BufferAttribute;
  private readonly normal: BufferAttribute;

  constructor(
    readonly geometry: BufferGeometry,
    form: SoftForm,
    finder: ElementFinder,
  ) {
    this.position = geometry.getAttribute("position") as BufferAttribute;
    this.normal = geometry.getAttribute("normal") as BufferAttribute;
    const count = this.position.count;
    this.nodes = new Uint32Array(4 * count);
    this.weights = new Float32Array(4 * count);
    this.offsets = Float32Array.from(this.position.array);
    this.anchors = new Float32Array(3 * count);
    this.normals = Float32Array.from(this.normal.array);
    const weights = new Float32Array(4);
    const pieces = new Uint32Array(count);
    const pieceOf = piecesOf(form);
    for (let v = 0; v < count; ++v) {
      const t = finder.find(this.offsets[3 * v]!, this.offsets[3 * v + 1]!, this.offsets[3 * v + 2]!, weights);
      pieces[v] = pieceOf[t]!;
      this.weights.set(weights, 4 * v);
      for (let k = 0; k < form.corners; ++k) {
        const node = form.elements[form.corners * t + k]!;
        this.nodes[4 * v + k] = node;
        for (let axis = 0; axis < 3; ++axis) this.anchors[3 * v + axis]! += weights[k]! * form.nodes[3 * node + axis]!;
      }
    }
    for (let at = 0; at < 3 * count; ++at) this.offsets[at]! -= this.anchors[at]!;
    cutBetween(geometry, pieces);
    this.position.setUsage(DynamicDrawUsage);
    this.normal.setUsage(DynamicDrawUsage);
    geometry.computeBoundingBox();
    geometry.computeBoundingSphere();
  }

  get count(): number {
    return this.position.count;
  }

  /** Sum of the lengths of its normals: as many as vertices. */
  normalLengths(): number {
    let sum = 0;
    for (let v = 0; v < this.count; ++v) sum += Math.hypot(this.normal.getX(v), this.normal.getY(v), this.normal.getZ(v));
    return sum;
  }

  /**
   * Where a vertex of cloth or a rope is: the mean of its element's nodes x, each with half of the way that the deformation F there makes
   * of that from the node X to the vertex at rest. Exact where the thing is bent as a parabola, so what is bent evenly looks round.
   */
  private round(v: number, places: Float32Array, form: SoftForm): [number, number, number] {
    const F = form.deformation;
    let [x, y, z] = [0, 0, 0];
    for (let k = 4 * v; k < 4 * v + form.corners; ++k) {
      const n = 3 * this.nodes[k]!;
      const m = 3 * n;
      const weight = this.weights[k]!;
      const dx = (this.anchors[3 * v]! - form.nodes[n]!) / 2;
      const dy = (this.anchors[3 * v + 1]! - form.nodes[n + 1]!) / 2;
      const dz = (this.anchors[3 * v + 2]! - form.nodes[n + 2]!) / 2;
      x += weight * (places[n]! + F[m]! * dx + F[m + 1]! * dy + F[m + 2]! * dz);
      y += weight * (places[n + 1]! + F[m + 3]! * dx + F[m + 4]! * dy + F[m + 5]! * dz);
      z += weight * (places[n + 2]! + F[m + 6]! * dx + F[m + 7]! * dy + F[m + 8]! * dz);
    }
    return [x, y, z];
  }

  /** Follows nodes at these places, with the deformation that `form` has found there. */
  follow(places: Float32Array, form: SoftForm): void {
    const { nodes, weights, offsets, normals } = this;
    const F = form.deformation;
    const to = this.position.array as Float32Array;
    const up = this.normal.array as Float32Array;
    const isThin = form.corners < 4;
    for (let v = 0, i = 0; i < to.length; ++v, i += 3) {
      let x = 0, y = 0, z = 0;
      let a = 0, b = 0, c = 0, d = 0, e = 0, f = 0, g = 0, h = 0, j = 0;
      for (let k = 4 * v; k < 4 * v + 4; ++k) {
        const weight = weights[k]!;
        const n = 3 * nodes[k]!;
        const m = 3 * n;
        x += weight * places[n]!;
        y += weight * places[n + 1]!;
        z += weight * places[n + 2]!;
        a += weight * F[m]!;
        b += weight * F[m + 1]!;
        c += weight * F[m + 2]!;
        d += weight * F[m + 3]!;
        e += weight * F[m + 4]!;
        f += weight * F[m + 5]!;
        g += weight * F[m + 6]!;
        h += weight * F[m + 7]!;
        j += weight * F[m + 8]!;
      }
      if (isThin) [x, y, z] = this.round(v, places, form);
      const [p, q, r] = [offsets[i]!, offsets[i + 1]!, offsets[i + 2]!];
      to[i] = x + a * p + b * q + c * r;
      to[i + 1] = y + d * p + e * q + f * r;
      to[i + 2] = z + g * p + h * q + j * r;

      // Normals go with the cofactors of the deformation.
      const [s, t, u] = [normals[i]!, normals[i + 1]!, normals[i + 2]!];
      const nx = (e * j - f * h) * s + (f * g - d * j) * t + (d * h - e * g) * u;
      const ny = (c * h - b * j) * s + (a * j - c * g) * t + (b * g - a * h) * u;
      const nz = (b * f - c * e) * s + (c * d - a * f) * t + (a * e - b * d) * u;
      const length = Math.hypot(nx, ny, nz) || 1;
      up[i] = nx / length;
      up[i + 1] = ny / length;
      up[i + 2] = nz / length;
    }
    this.position.needsUpdate = true;
    this.normal.needsUpdate = true;
    // The same boxes and spheres, since others hold them.
    this.geometry.boundingBox!.setFromBufferAttribute(this.position);
    this.geometry.boundingBox!.getBoundingSphere(this.geometry.boundingSphere!);
  }
}

/** A drawable of its own that bends with the nodes of one entity: its geometries are its own, the materials those it was made of. */
export class SoftSkin {
  readonly drawable: Drawable;
  private readonly parts: CarriedPart[];

  constructor(
    readonly form: SoftForm,
    plain: Drawable,
  ) {
    const finder = new ElementFinder(form);
    // Nothing is left to draw of a rope that is broken everywhere.
    const shown = form.count > 0 ? plain.parts : [];
    const parts: DrawablePart[] = shown.map(({ geometry, material, matrix }) => ({
      geometry: refine(geometry, matrix, form.corners < 4 ? THIN_SHARE * form.edge : form.edge),
      material,
      matrix: NONE,
    }));
    this.parts = parts.map(({ geometry }) => new CarriedPart(geometry, form, finder));
    this.drawable = { parts, bounds: plain.bounds.clone(), castsShadow: plain.castsShadow, hasTwoSides: form.corners === 3 };
  }

  /** As it is drawn now; for tests. */
  measure(): { size: number[]; vertices: number; normals: number } {
    const vertices = this.parts.reduce((sum, part) => sum + part.count, 0);
    const normals = this.parts.reduce((sum, part) => sum + part.normalLengths(), 0) / (vertices || 1);
    return { size: this.drawable.bounds.getSize(new Vector3()).toArray(), vertices, normals };
  }

  /** Bends as the nodes are (x, y, z each, in the entity's frame without its scale). */
  follow(places: Float32Array): void {
    this.form.deform(places);
    this.drawable.bounds.makeEmpty();
    for (const part of this.parts) {
      part.follow(places, this.form);
      this.drawable.bounds.union(part.geometry.boundingBox!);
    }
  }
}
