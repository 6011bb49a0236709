// SPDX-License-Identifier: MIT
import { BufferAttribute, BufferGeometry, DynamicDrawUsage, Matrix4, Matrix3, Quaternion, Vector3 } from "three";
import type { SimulationMesh } from "../connection/messages";
import { type Drawable, type DrawablePart, isClosed } from "./drawable";
import { ElementFinder } from "./element_finder";
import { refine, type Refined } from "./refine";
import type { Quality } from "./tint";
import { cutAlongTears, originsOf, TornSheet } from "./torn_sheet";

const NONE = new Matrix4();
/** Longest drawn edges, in edges of the elements: short ones look round between the nodes of cloth and ropes. */
const LONGEST: Record<Quality, { solid: number; cloth: number; rope: number }> = {
  high: { solid: 1, cloth: 0.7, rope: 0.7 },
  low: { solid: 1, cloth: 1, rope: 0.7 },
};

/** The nodes of the elements: four for each of a solid, three of cloth, two of a rope. */
function elementsOf(mesh: SimulationMesh): { corners: number; elements: number[] } {
  if (mesh.tetrahedra) return { corners: 4, elements: mesh.tetrahedra };
  if (mesh.triangles) return { corners: 3, elements: mesh.triangles };
  const elements: number[] = [];
  for (let node = 0; node + 1 < mesh.nodes.length / 3; ++node) if (!mesh.broken?.includes(node)) elements.push(node, node + 1);
  return { corners: 2, elements };
}

/**
 * Elements at rest, and the deformation around them by the present nodes, in the entity's frame. Each element has three directions
 * that deform with it: three edges of a solid; two of cloth and its unit normal; a rope's edge and two across it, which rotate with
 * the rope but do not twist about it.
 */
export class SoftForm {
  readonly nodes: Float32Array;
  readonly elements: Uint32Array;
  /** Number of nodes of an element. */
  readonly corners: number;
  /** Mean length of the edges, m. */
  readonly edge: number;
  /** For each node nine numbers by rows: the deformation gradient, the mean of its elements' weighted by their size. */
  readonly deformation: Float32Array;
  /** Of a torn sheet: for each node the one that it came from. Null where nothing is torn. */
  readonly origins: Uint32Array | null;
  /** For each element nine numbers by rows: the matrix from a vector from its first node to its components along the directions at rest. */
  private readonly inverse: Float32Array;
  private readonly amount: Float32Array;
  /** For each node: one divided by the total size of its elements. */
  private readonly shareOf: Float32Array;
  /** Reused memory, so that nothing is allocated while nodes move. */
  private readonly scratch = { frame: new RopeFrame(), e: new Vector3(), f: new Vector3(), g: new Vector3(), of: new Float64Array(9) };

  /** `scale`: of the entity; the mesh's nodes have it applied. */
  constructor(mesh: SimulationMesh, scale: number) {
    const { corners, elements } = elementsOf(mesh);
    this.nodes = Float32Array.from(mesh.nodes, (number) => number / scale);
    this.elements = Uint32Array.from(elements);
    this.corners = corners;
    this.origins = corners === 3 ? originsOf(this.nodes) : null;
    const count = this.count;
    this.inverse = new Float32Array(9 * count);
    this.amount = new Float32Array(count);
    this.shareOf = new Float32Array(this.nodes.length / 3);
    this.deformation = new Float32Array(3 * this.nodes.length);
    const matrix = new Matrix3();
    const { frame, e, f, g } = this.scratch;
    let lengths = 0;
    for (let t = 0; t < count; ++t) {
      this.directions(t, this.nodes, frame, e, f, g);
      lengths += e.length();
      matrix.set(e.x, f.x, g.x, e.y, f.y, g.y, e.z, f.z, g.z);
      this.amount[t] = Math.abs(matrix.determinant());
      this.inverse.set(matrix.invert().transpose().elements, 9 * t);
      for (let k = 0; k < corners; ++k) this.shareOf[this.elements[corners * t + k]!]! += this.amount[t]!;
    }
    for (let node = 0; node < this.shareOf.length; ++node) this.shareOf[node] = this.shareOf[node]! > 0 ? 1 / this.shareOf[node]! : 1;
    this.edge = count > 0 ? lengths / count : 1;
  }

  get count(): number {
    return this.elements.length / this.corners;
  }

  /** Whether the elements of the other are at the same places at rest, whatever their nodes are. */
  isSameAtRest(other: SoftForm): boolean {
    if (this.corners !== other.corners || this.count !== other.count) return false;
    const isAt = (i: number, k: number) => this.nodes[3 * this.elements[i]! + k] === other.nodes[3 * other.elements[i]! + k];
    for (let i = 0; i < this.elements.length; ++i) if (!isAt(i, 0) || !isAt(i, 1) || !isAt(i, 2)) return false;
    return true;
  }

  /** Barycentric weights of the nodes at a point: outside of the element some are negative. */
  weightsAt(t: number, x: number, y: number, z: number, weights: Float32Array): void {
    const at = 3 * this.elements[this.corners * t]!;
    const m = this.inverse;
    const i = 9 * t;
    const dx = x - this.nodes[at]!, dy = y - this.nodes[at + 1]!, dz = z - this.nodes[at + 2]!;
    weights[0] = 1;
    for (let k = 0; k + 1 < this.corners; ++k) {
      weights[k + 1] = m[i + 3 * k]! * dx + m[i + 3 * k + 1]! * dy + m[i + 3 * k + 2]! * dz;
      weights[0]! -= weights[k + 1]!;
    }
  }

  /** Computes the deformation with the nodes at these positions (x, y, z each). */
  deform(places: Float32Array): void {
    const { deformation, elements, inverse, corners, amount, shareOf, scratch } = this;
    const { frame, e, f, g, of } = scratch;
    deformation.fill(0);
    frame.begin();
    for (let t = 0, i = 0; t < amount.length; ++t, i += 9) {
      this.directions(t, places, frame, e, f, g);
      for (let row = 0; row < 3; ++row) {
        const p = amount[t]! * (row === 0 ? e.x : row === 1 ? e.y : e.z);
        const q = amount[t]! * (row === 0 ? f.x : row === 1 ? f.y : f.z);
        const r = amount[t]! * (row === 0 ? g.x : row === 1 ? g.y : g.z);
        for (let column = i; column < i + 3; ++column)
          of[3 * row + column - i] = p * inverse[column]! + q * inverse[column + 3]! + r * inverse[column + 6]!;
      }
      for (let k = corners * t; k < corners * t + corners; ++k)
        for (let at = 9 * elements[k]!, which = 0; which < 9; ++which) deformation[at + which]! += of[which]!;
    }
    for (let node = 0; node < shareOf.length; ++node)
      for (let k = 9 * node; k < 9 * node + 9; ++k) deformation[k]! *= shareOf[node]!;
  }

  /** An element's three directions with the nodes at these positions; those of a rope follow from the element before. */
  private directions(t: number, places: Float32Array, frame: RopeFrame, e: Vector3, f: Vector3, g: Vector3): void {
    const { corners } = this;
    this.between(corners * t, 1, places, e);
    if (corners === 2) {
      frame.follow(e, f, g);
      return;
    }
    this.between(corners * t, 2, places, f);
    if (corners === 3) g.crossVectors(e, f).normalize();
    else this.between(corners * t, 3, places, g);
  }

  /** The vector from the first node of the element whose nodes begin at `first` to its node `k`. */
  private between(first: number, k: number, places: Float32Array, way: Vector3): void {
    const from = 3 * this.elements[first]!;
    const to = 3 * this.elements[first + k]!;
    way.x = places[to]! - places[from]!;
    way.y = places[to + 1]! - places[from + 1]!;
    way.z = places[to + 2]! - places[from + 2]!;
  }
}

/** Two directions across a polyline, by parallel transport: rotated as little as possible from one edge to the next. */
class RopeFrame {
  private readonly tangent = new Vector3();
  private readonly across = new Vector3();
  private readonly now = new Vector3();
  private readonly turn = new Quaternion();

  /** Call before the first edge of a polyline. */
  begin(): void {
    this.tangent.set(0, 0, 0);
  }

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

/** A number for each element: different on the two sides of a break of a rope. */
function piecesOf(form: SoftForm): Uint32Array {
  const pieces = new Uint32Array(form.count);
  if (form.corners > 2) return pieces;
  for (let t = 1; t < form.count; ++t) pieces[t] = pieces[t - 1]! + (form.elements[2 * t] === form.elements[2 * t - 1] ? 0 : 1);
  return pieces;
}

/** Removes the triangles that would join different pieces. */
function cutBetween(geometry: BufferGeometry, pieces: Uint32Array): void {
  const index = geometry.index!.array;
  const kept: number[] = [];
  for (let at = 0; at < index.length; at += 3) {
    const [a, b, c] = [index[at]!, index[at + 1]!, index[at + 2]!];
    if (pieces[a] === pieces[b] && pieces[b] === pieces[c]) kept.push(a, b, c);
  }
  if (kept.length < index.length) geometry.setIndex(kept);
}

/** A drawn part whose vertices are carried by the elements: by the weights of one's nodes, and outside of it by its deformation. */
class CarriedPart {
  private readonly nodes: Uint32Array;
  private readonly weights: Float32Array;
  private readonly offsets: Float32Array;
  /**
   * For cloth and ropes, for each corner: half the vector w from its node at rest to the point of the element that carries the vertex.
   * A node x with deformation gradient F predicts that point at x + F w; the mean of the predictions is exact where the entity is bent
   * to a parabola, so that uniform bending looks round. Empty for solids.
   */
  private readonly ways: Float32Array;
  private readonly normals: Float32Array;
  private readonly position: BufferAttribute;
  private readonly normal: BufferAttribute;

  constructor(
    readonly geometry: BufferGeometry,
    form: SoftForm,
    finder: ElementFinder,
    /** For each vertex the element that carries it. */
    elements: ArrayLike<number>,
  ) {
    this.position = geometry.getAttribute("position") as BufferAttribute;
    this.normal = geometry.getAttribute("normal") as BufferAttribute;
    const count = this.position.count;
    const { corners } = form;
    this.nodes = new Uint32Array(corners * count);
    this.weights = new Float32Array(corners * count);
    this.offsets = Float32Array.from(this.position.array);
    this.ways = new Float32Array(corners < 4 ? 3 * corners * count : 0);
    this.normals = Float32Array.from(this.normal.array);
    const weights = new Float32Array(4);
    const pieces = new Uint32Array(count);
    const pieceOf = piecesOf(form);
    const anchor = new Vector3();
    for (let v = 0; v < count; ++v) {
      anchor.fromArray(this.offsets, 3 * v);
      const t = elements[v]!;
      finder.weigh(t, anchor.x, anchor.y, anchor.z, weights);
      pieces[v] = pieceOf[t]!;
      anchor.set(0, 0, 0);
      for (let k = 0; k < corners; ++k) {
        const node = form.elements[corners * t + k]!;
        this.nodes[corners * v + k] = node;
        this.weights[corners * v + k] = weights[k]!;
        anchor.x += weights[k]! * form.nodes[3 * node]!;
        anchor.y += weights[k]! * form.nodes[3 * node + 1]!;
        anchor.z += weights[k]! * form.nodes[3 * node + 2]!;
      }
      this.offsets[3 * v]! -= anchor.x;
      this.offsets[3 * v + 1]! -= anchor.y;
      this.offsets[3 * v + 2]! -= anchor.z;
      for (let k = corners * v; corners < 4 && k < corners * v + corners; ++k) {
        const n = 3 * this.nodes[k]!;
        this.ways[3 * k] = (anchor.x - form.nodes[n]!) / 2;
        this.ways[3 * k + 1] = (anchor.y - form.nodes[n + 1]!) / 2;
        this.ways[3 * k + 2] = (anchor.z - form.nodes[n + 2]!) / 2;
      }
    }
    cutBetween(geometry, pieces);
    this.position.setUsage(DynamicDrawUsage);
    this.normal.setUsage(DynamicDrawUsage);
    geometry.computeBoundingBox();
    geometry.computeBoundingSphere();
  }

  get count(): number {
    return this.position.count;
  }

  /** Sum of the lengths of the normals: equal to the number of vertices. */
  normalLengths(): number {
    let sum = 0;
    for (let v = 0; v < this.count; ++v) sum += Math.hypot(this.normal.getX(v), this.normal.getY(v), this.normal.getZ(v));
    return sum;
  }

  /** Moves the vertices with nodes at these positions, with the deformation that `form` has computed. */
  follow(places: Float32Array, form: SoftForm): void {
    const { nodes, weights, offsets, normals, ways } = this;
    const { corners, deformation: F } = form;
    const isThin = corners < 4;
    const to = this.position.array as Float32Array;
    const up = this.normal.array as Float32Array;
    let lowX = Infinity, lowY = Infinity, lowZ = Infinity;
    let highX = -Infinity, highY = -Infinity, highZ = -Infinity;
    for (let v = 0, i = 0; i < to.length; ++v, i += 3) {
      let x = 0, y = 0, z = 0;
      let a = 0, b = 0, c = 0, d = 0, e = 0, f = 0, g = 0, h = 0, j = 0;
      for (let k = corners * v; k < corners * v + corners; ++k) {
        const weight = weights[k]!;
        const n = 3 * nodes[k]!;
        const m = 3 * n;
        x += weight * places[n]!;
        y += weight * places[n + 1]!;
        z += weight * places[n + 2]!;
        const A = weight * F[m]!, B = weight * F[m + 1]!, C = weight * F[m + 2]!;
        const D = weight * F[m + 3]!, E = weight * F[m + 4]!, G = weight * F[m + 5]!;
        const H = weight * F[m + 6]!, J = weight * F[m + 7]!, K = weight * F[m + 8]!;
        a += A, b += B, c += C, d += D, e += E, f += G, g += H, h += J, j += K;
        if (!isThin) continue;
        const p = ways[3 * k]!, q = ways[3 * k + 1]!, r = ways[3 * k + 2]!;
        x += A * p + B * q + C * r;
        y += D * p + E * q + G * r;
        z += H * p + J * q + K * r;
      }
      const p = offsets[i]!, q = offsets[i + 1]!, r = offsets[i + 2]!;
      x += a * p + b * q + c * r;
      y += d * p + e * q + f * r;
      z += g * p + h * q + j * r;
      to[i] = x, to[i + 1] = y, to[i + 2] = z;
      if (x < lowX) lowX = x;
      if (y < lowY) lowY = y;
      if (z < lowZ) lowZ = z;
      if (x > highX) highX = x;
      if (y > highY) highY = y;
      if (z > highZ) highZ = z;

      // Normals are transformed by the cofactors of the deformation gradient.
      const s = normals[i]!, t = normals[i + 1]!, u = normals[i + 2]!;
      const nx = (e * j - f * h) * s + (f * g - d * j) * t + (d * h - e * g) * u;
      const ny = (c * h - b * j) * s + (a * j - c * g) * t + (b * g - a * h) * u;
      const nz = (b * f - c * e) * s + (c * d - a * f) * t + (a * e - b * d) * u;
      // Math.hypot is several times slower; overflow is impossible here.
      const length = Math.sqrt(nx * nx + ny * ny + nz * nz);
      const by = length > 0 ? 1 / length : 0;
      up[i] = nx * by, up[i + 1] = ny * by, up[i + 2] = nz * by;
    }
    this.position.needsUpdate = true;
    this.normal.needsUpdate = true;
    // The same boxes and spheres are updated, because other objects refer to them.
    this.geometry.boundingBox!.min.set(lowX, lowY, lowZ);
    this.geometry.boundingBox!.max.set(highX, highY, highZ);
    this.geometry.boundingBox!.getBoundingSphere(this.geometry.boundingSphere!);
  }
}

/** Coarser levels of what bends. */
const LEVELS = 8;
/** So far a straight edge is from a surface that bends by 90 degrees along it, in its lengths. */
const SAG = 0.2;

/** For each error the fewest triangles that keep to it: of the stages of refinement, or of the levels of the form at rest. */
function coarserLevels({ geometry, stages }: Refined, { levels }: DrawablePart, restErrors: readonly number[], errors: readonly number[]): (BufferAttribute | null)[] {
  const position = geometry.getAttribute("position").array;
  const coarser = [
    ...stages.map((index) => ({ index: new BufferAttribute(new Uint32Array(index), 1), error: SAG * longestEdge(index, position) })),
    ...(levels ?? []).map((index, at) => ({ index, error: Math.max(restErrors[at]!, index ? SAG * longestEdge(index.array, position) : 0) })),
  ];
  let best = geometry.index as BufferAttribute | null;
  return errors.map((most) => {
    for (const { index, error } of coarser) if (error <= most && (index?.count ?? 0) < (best?.count ?? 0)) best = index;
    return best;
  });
}

function longestEdge(index: ArrayLike<number>, position: ArrayLike<number>): number {
  let most = 0;
  for (let i = 0; i < index.length; ++i) {
    const a = 3 * index[i]!;
    const b = 3 * index[i % 3 === 2 ? i - 2 : i + 1]!;
    const x = position[a]! - position[b]!, y = position[a + 1]! - position[b + 1]!, z = position[a + 2]! - position[b + 2]!;
    most = Math.max(most, x * x + y * y + z * z);
  }
  return Math.sqrt(most);
}

/** Of each part of a drawable the refined geometry at rest, and for each of its vertices the nearest element: the same however far a sheet is torn. */
class RestForm {
  readonly finder: ElementFinder;
  readonly parts: { refined: Refined; elements: Uint32Array }[];

  constructor(
    private readonly form: SoftForm,
    private readonly plain: readonly DrawablePart[],
    private readonly longest: number,
  ) {
    this.finder = new ElementFinder(form);
    this.parts = plain.map((part) => {
      const refined = refine(part.geometry, part.matrix, longest);
      return { refined, elements: nearestElements(refined.geometry, this.finder) };
    });
  }

  /** Whether it is that of these, too. */
  fits(form: SoftForm, plain: readonly DrawablePart[], longest: number): boolean {
    return longest === this.longest && form.isSameAtRest(this.form) && plain.length === this.plain.length && plain.every((part, at) => hasSameForm(part, this.plain[at]!));
  }
}

function nearestElements(geometry: BufferGeometry, finder: ElementFinder): Uint32Array {
  const at = geometry.getAttribute("position").array;
  const weights = new Float32Array(4);
  return Uint32Array.from({ length: at.length / 3 }, (_, v) => finder.find(at[3 * v]!, at[3 * v + 1]!, at[3 * v + 2]!, weights));
}

function hasSameForm(a: DrawablePart, b: DrawablePart): boolean {
  const arrays = ({ geometry }: DrawablePart) => [geometry.getAttribute("position").array, geometry.index?.array ?? []];
  const [ours, theirs] = [arrays(a), arrays(b)];
  return a.matrix.equals(b.matrix) && ours.every((array, which) => isSame(array, theirs[which]!));
}

function isSame(a: ArrayLike<number>, b: ArrayLike<number>): boolean {
  if (a === b) return true;
  if (a.length !== b.length) return false;
  for (let i = 0; i < a.length; ++i) if (a[i] !== b[i]) return false;
  return true;
}

/** A drawable that bends with the nodes of one entity: it has its own geometries and the materials of its original. */
export class SoftSkin {
  readonly drawable: Drawable;
  private readonly parts: CarriedPart[];
  private readonly rest: RestForm;

  /** `before`: the skin that this one takes the place of, which may know most of it already. */
  constructor(
    readonly form: SoftForm,
    plain: Drawable,
    quality: Quality,
    before: SoftSkin | null = null,
  ) {
    const { solid, cloth, rope } = LONGEST[quality];
    const longest = form.edge * (form.corners === 4 ? solid : form.corners === 3 ? cloth : rope);
    const torn = form.origins && new TornSheet(form.elements, form.origins);
    // A rope that is broken everywhere has nothing to draw.
    const shown = form.count > 0 ? plain.parts : [];
    this.rest = before?.rest.fits(form, shown, longest) ? before.rest : new RestForm(form, shown, longest);
    const { finder } = this.rest;
    const levelErrors = Array.from({ length: LEVELS }, (_, level) => SAG * longest * 2 ** (level + 1));
    this.parts = [];
    const parts: DrawablePart[] = shown.map((part, at) => {
      const { refined, elements } = this.rest.parts[at]!;
      const cut = torn && cutAlongTears(refined.geometry, elements, finder, torn);
      const geometry = cut?.geometry ?? refined.geometry.clone();
      const whole = geometry.index!.count;
      this.parts.push(new CarriedPart(geometry, form, finder, cut?.elements ?? elements));
      // Coarser triangles of a broken rope or a torn sheet would join its pieces.
      const isCut = cut !== null || geometry.index!.count < whole;
      const levels = isCut ? levelErrors.map(() => geometry.index) : coarserLevels({ ...refined, geometry }, part, plain.levelErrors ?? [], levelErrors);
      return { geometry, material: part.material, matrix: NONE, levels };
    });
    this.drawable = { parts, levelErrors, bounds: plain.bounds.clone(), castsShadow: plain.castsShadow, bends: true, ...(form.corners === 3 && { isCloth: true, hasTwoSides: !plain.parts.every(({ geometry }) => isClosed(geometry)) }) };
  }

  /** Measures the drawn form; for tests. */
  measure(): { size: number[]; vertices: number; normals: number } {
    const vertices = this.parts.reduce((sum, part) => sum + part.count, 0);
    const normals = this.parts.reduce((sum, part) => sum + part.normalLengths(), 0) / (vertices || 1);
    return { size: this.drawable.bounds.getSize(new Vector3()).toArray(), vertices, normals };
  }

  /** Bends to these nodes (x, y, z each, in the entity's frame without its scale). */
  follow(places: Float32Array): void {
    this.form.deform(places);
    this.drawable.bounds.makeEmpty();
    for (const part of this.parts) {
      part.follow(places, this.form);
      this.drawable.bounds.union(part.geometry.boundingBox!);
    }
  }
}
