// SPDX-License-Identifier: MIT
import { Box3, BufferAttribute, BufferGeometry, DynamicDrawUsage, Matrix4, Matrix3, Vector3 } from "three";
import type { SimulationMesh } from "../connection/messages";
import type { Drawable, DrawablePart } from "./drawable";
import { refine } from "./refine";

const NONE = new Matrix4();

/** Tetrahedra at rest, and how their nodes have turned and stretched what is around them. In the drawn thing's own frame. */
export class SoftForm {
  readonly nodes: Float32Array;
  readonly tetrahedra: Uint32Array;
  /** Mean length of the edges, m. */
  readonly edge: number;
  /** Of each node nine numbers by rows: the deformation around it, the mean of its tetrahedra's by volume. */
  readonly deformation: Float32Array;
  /** Of each tetrahedron nine numbers by rows: what takes a place beside its first node to the weights of the other three. */
  private readonly inverse: Float32Array;
  private readonly volume: Float32Array;
  private readonly share: Float32Array;

  /** `scale`: of the entity; the mesh has it in its nodes. */
  constructor(mesh: SimulationMesh, scale: number) {
    this.nodes = Float32Array.from(mesh.nodes, (number) => number / scale);
    this.tetrahedra = Uint32Array.from(mesh.tetrahedra);
    const count = this.tetrahedra.length / 4;
    this.inverse = new Float32Array(9 * count);
    this.volume = new Float32Array(count);
    this.share = new Float32Array(this.nodes.length / 3);
    this.deformation = new Float32Array(3 * this.nodes.length);
    const edges = [new Vector3(), new Vector3(), new Vector3()] as const;
    const first = new Vector3();
    const matrix = new Matrix3();
    let lengths = 0;
    for (let t = 0; t < count; ++t) {
      first.fromArray(this.nodes, 3 * this.tetrahedra[4 * t]!);
      edges.forEach((edge, k) => {
        edge.fromArray(this.nodes, 3 * this.tetrahedra[4 * t + k + 1]!).sub(first);
        lengths += edge.length();
      });
      matrix.set(edges[0].x, edges[1].x, edges[2].x, edges[0].y, edges[1].y, edges[2].y, edges[0].z, edges[1].z, edges[2].z);
      this.volume[t] = Math.abs(matrix.determinant()) / 6;
      this.inverse.set(matrix.invert().transpose().elements, 9 * t);
      for (let k = 0; k < 4; ++k) this.share[this.tetrahedra[4 * t + k]!]! += this.volume[t]!;
    }
    this.edge = lengths / (3 * count);
  }

  /** Weights of the four nodes at a place: some are negative outside. */
  weightsAt(t: number, x: number, y: number, z: number, weights: Float32Array): void {
    const at = 3 * this.tetrahedra[4 * t]!;
    const m = this.inverse;
    const i = 9 * t;
    const [dx, dy, dz] = [x - this.nodes[at]!, y - this.nodes[at + 1]!, z - this.nodes[at + 2]!];
    for (let k = 0; k < 3; ++k) weights[k + 1] = m[i + 3 * k]! * dx + m[i + 3 * k + 1]! * dy + m[i + 3 * k + 2]! * dz;
    weights[0] = 1 - weights[1]! - weights[2]! - weights[3]!;
  }

  /** Finds the deformation with the nodes at these places (x, y, z each). */
  deform(places: Float32Array): void {
    const { deformation, tetrahedra, inverse } = this;
    deformation.fill(0);
    for (let t = 0, i = 0; t < tetrahedra.length; t += 4, i += 9) {
      const [a, b, c, d] = [3 * tetrahedra[t]!, 3 * tetrahedra[t + 1]!, 3 * tetrahedra[t + 2]!, 3 * tetrahedra[t + 3]!];
      const volume = this.volume[t / 4]!;
      for (let row = 0; row < 3; ++row) {
        const origin = places[a + row]!;
        const [e, f, g] = [places[b + row]! - origin, places[c + row]! - origin, places[d + row]! - origin];
        for (let column = 0; column < 3; ++column) {
          const value = volume * (e * inverse[i + column]! + f * inverse[i + 3 + column]! + g * inverse[i + 6 + column]!);
          const at = 3 * row + column;
          deformation[3 * a + at]! += value;
          deformation[3 * b + at]! += value;
          deformation[3 * c + at]! += value;
          deformation[3 * d + at]! += value;
        }
      }
    }
    for (let node = 0; node < this.share.length; ++node)
      for (let k = 9 * node; k < 9 * node + 9; ++k) deformation[k]! /= this.share[node]!;
  }
}

/** Finds the tetrahedron around a place, or the nearest one. */
class TetrahedronFinder {
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
    for (let t = 0; t < form.tetrahedra.length / 4; ++t) {
      around.makeEmpty();
      for (let k = 0; k < 4; ++k) around.expandByPoint(corner.fromArray(form.nodes, 3 * form.tetrahedra[4 * t + k]!));
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

  /** To the place with the weights cut off at zero: 0 inside. Leaves these in `own`. */
  private distanceTo(t: number, x: number, y: number, z: number): number {
    const { nodes, tetrahedra } = this.form;
    this.form.weightsAt(t, x, y, z, this.own);
    if (this.own.every((weight) => weight >= 0)) return 0;
    let sum = 0;
    for (let k = 0; k < 4; ++k) sum += this.own[k] = Math.max(0, this.own[k]!);
    let [dx, dy, dz] = [x, y, z];
    for (let k = 0; k < 4; ++k) {
      const at = 3 * tetrahedra[4 * t + k]!;
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

/** A drawn part whose vertices are carried by the tetrahedra: each by four nodes, and by the deformation there for what lies outside. */
class CarriedPart {
  private readonly nodes: Uint32Array;
  private readonly weights: Float32Array;
  private readonly offsets: Float32Array;
  private readonly normals: Float32Array;
  private readonly position: BufferAttribute;
  private readonly normal: BufferAttribute;

  constructor(
    readonly geometry: BufferGeometry,
    form: SoftForm,
    finder: TetrahedronFinder,
  ) {
    this.position = geometry.getAttribute("position") as BufferAttribute;
    this.normal = geometry.getAttribute("normal") as BufferAttribute;
    const count = this.position.count;
    this.nodes = new Uint32Array(4 * count);
    this.weights = new Float32Array(4 * count);
    this.offsets = Float32Array.from(this.position.array);
    this.normals = Float32Array.from(this.normal.array);
    const weights = new Float32Array(4);
    for (let v = 0; v < count; ++v) {
      const t = finder.find(this.offsets[3 * v]!, this.offsets[3 * v + 1]!, this.offsets[3 * v + 2]!, weights);
      this.weights.set(weights, 4 * v);
      for (let k = 0; k < 4; ++k) {
        const node = form.tetrahedra[4 * t + k]!;
        this.nodes[4 * v + k] = node;
        for (let axis = 0; axis < 3; ++axis) this.offsets[3 * v + axis]! -= weights[k]! * form.nodes[3 * node + axis]!;
      }
    }
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

  /** Follows nodes at these places, with the deformation that `form` has found there. */
  follow(places: Float32Array, form: SoftForm): void {
    const { nodes, weights, offsets, normals } = this;
    const F = form.deformation;
    const to = this.position.array as Float32Array;
    const up = this.normal.array as Float32Array;
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
    const finder = new TetrahedronFinder(form);
    const parts: DrawablePart[] = plain.parts.map(({ geometry, material, matrix }) => ({
      geometry: refine(geometry, matrix, form.edge),
      material,
      matrix: NONE,
    }));
    this.parts = parts.map(({ geometry }) => new CarriedPart(geometry, form, finder));
    this.drawable = { parts, bounds: plain.bounds.clone(), castsShadow: plain.castsShadow };
  }

  /** As it is drawn now; for tests. */
  measure(): { size: number[]; vertices: number; normals: number } {
    const vertices = this.parts.reduce((sum, part) => sum + part.count, 0);
    const normals = this.parts.reduce((sum, part) => sum + part.normalLengths(), 0) / vertices;
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
