// SPDX-License-Identifier: MIT
import { Box3, BufferAttribute, BufferGeometry, InterleavedBuffer, InterleavedBufferAttribute, type TypedArray, Vector3 } from "three";

/** A level is thinned out only where it has more triangles than this, and more than one for so many pixels of the model's square on the screen. */
const FEW_TRIANGLES = 500;
const PIXELS_A_TRIANGLE = 4;
/** A piece that is drawn for several may be so large, in errors of the level. */
const LARGEST_COPY = 2;
/** Nothing is thinned out where fewer pieces than this would be drawn for one. */
const LEAST_SHARE = 1.7;
/** A piece up to so large, in errors of the level, may become a few triangles between its outermost vertices. */
const LARGEST_OUTLINE = 6;
/** More than the triangles of an outline. */
const MANY_TRIANGLES = 5;
/** A piece thicker than this part of its size is no leaf: its outline is a tetrahedron. */
const THICK = 0.25;
/** An outline is larger than its piece by this at most: that of a ball is 1.65. */
const LARGEST_SWELL = 1.7;
/** A piece whose faces look to one side by less than this part of their area has two layers, or is closed. */
const ONE_SIDED = 0.5;

type Vertices = BufferAttribute | InterleavedBufferAttribute;

/** What a part is drawn with: its vertices, and the triangles of its coarser levels. */
interface Leveled {
  geometry: BufferGeometry;
  levels: (BufferAttribute | null)[];
}

/** The pieces of a list of triangles. */
interface Pieces {
  /** Of each triangle, the number of its piece. */
  of: Uint32Array;
  /** The triangles of one piece after the other, and where each piece's begin; one number more than there are pieces. */
  triangles: Uint32Array;
  begins: Uint32Array;
  /** Of each piece, its middle and the diagonal of its box, in the geometry's units: four numbers each. */
  boxes: Float64Array;
}

/**
 * Thins out what no collapsing of edges makes simpler: leaves, petals, beads, wickerwork. Of each piece that is small beside a level's error only an
 * outline is left; of those that are smaller still every k-th is drawn, as large as k of them together (Cook and others 2007, "Stochastic
 * simplification of aggregate detail"). Areas stay. `errors` and the model's largest `extent` in m, `scale` is the geometry's unit in
 * metres. The vertices of pieces that became larger stand behind the part's own ones.
 */
export function thinOut(geometry: BufferGeometry, levels: readonly (BufferAttribute | null)[], errors: readonly number[], extent: number, scale: number): Leveled {
  // A level is drawn where its error is about a pixel.
  const isRich = levels.map((level, at) => (level?.count ?? 0) / 3 > Math.max(FEW_TRIANGLES, (extent / errors[at]!) ** 2 / PIXELS_A_TRIANGLE));
  if (!isRich.includes(true)) return { geometry, levels: [...levels] };
  const maker = new Maker(geometry);
  const thinned = levels.map((level, at) => (isRich[at] ? maker.thin(level!, errors[at]! / scale) : level));
  const { copies } = maker;
  return copies.count === 0 ? { geometry, levels: [...levels] } : { geometry: copies.extended(), levels: thinned.map((level) => level && new BufferAttribute(compact(level.array, copies.total), 1)) };
}

/** Makes the thinned lists of triangles of one geometry. */
class Maker {
  readonly copies: Copies;
  private readonly places: Float32Array;
  private readonly normals: Float32Array;
  private readonly welded: Uint32Array;
  private known: { level: BufferAttribute; connected: Uint32Array } | null = null;

  constructor(geometry: BufferGeometry) {
    this.copies = new Copies(geometry);
    this.places = read(geometry.getAttribute("position"));
    this.normals = read(geometry.getAttribute("normal"));
    this.welded = weld(this.places);
  }

  /** `error` in the geometry's units. */
  thin(level: BufferAttribute, error: number): BufferAttribute {
    const pieces = this.piecesOf(level, LARGEST_COPY * error);
    const { boxes, begins } = pieces;
    const out: number[] = [];
    let share = 0;
    let isSame = true;
    for (let piece = 0; piece + 1 < begins.length; ++piece) {
      const size = boxes[4 * piece + 3]!;
      let factor = (LARGEST_COPY * error) / size;
      if (factor * factor < LEAST_SHARE) factor = 1;
      else {
        // Pieces follow each other as they grow, so that every k-th of them is spread evenly.
        const before = Math.floor(share);
        share += 1 / (factor * factor);
        isSame = false;
        if (Math.floor(share) === before) continue;
      }
      const hasOutline = size < LARGEST_OUTLINE * error && begins[piece + 1]! - begins[piece]! > MANY_TRIANGLES;
      if (!hasOutline || !this.outline(level, pieces, piece, factor, out)) this.whole(level, pieces, piece, factor, out);
      else isSame = false;
    }
    return isSame ? level : new BufferAttribute(new Uint32Array(out), 1);
  }

  private whole(level: BufferAttribute, { triangles, begins, boxes }: Pieces, piece: number, factor: number, out: number[]): void {
    const known = new Map<number, number>();
    for (let at = begins[piece]!; at < begins[piece + 1]!; ++at)
      for (let k = 0; k < 3; ++k) {
        const vertex = level.getX(3 * triangles[at]! + k);
        let drawn = factor === 1 ? vertex : known.get(vertex);
        if (drawn === undefined) known.set(vertex, (drawn = this.copies.add(vertex, this.places, boxes, 4 * piece, factor)));
        out.push(drawn);
      }
  }

  /** The piece as two triangles on each of its sides, or as a tetrahedron; false where its vertices span nothing. */
  private outline(level: BufferAttribute, { triangles, begins, boxes }: Pieces, piece: number, factor: number, out: number[]): boolean {
    const { places, normals } = this;
    const vertices = new Set<number>();
    const facing = new Vector3();
    let area = 0;
    for (let at = begins[piece]!; at < begins[piece + 1]!; ++at) {
      const corners = [0, 1, 2].map((k) => level.getX(3 * triangles[at]! + k)) as [number, number, number];
      const face = this.face(...corners);
      area += face.length();
      facing.add(face);
      for (const vertex of corners) vertices.add(vertex);
    }
    const place = (vertex: number, to: Vector3) => to.fromArray(places, 3 * vertex);
    const furthest = (measure: (at: Vector3) => number) => {
      let [most, which] = [-Infinity, 0];
      for (const vertex of vertices) {
        const value = measure(place(vertex, point));
        if (value > most) [most, which] = [value, vertex];
      }
      return which;
    };
    const middle = new Vector3().fromArray(boxes, 4 * piece);
    const a = furthest((at) => at.distanceToSquared(middle));
    const from = place(a, new Vector3());
    const b = furthest((at) => at.distanceToSquared(from));
    const along = place(b, new Vector3()).sub(from);
    const across = (at: Vector3) => side.copy(at).sub(from).cross(along);
    const c = furthest((at) => across(at).lengthSq());
    const normal = across(place(c, new Vector3())).clone();
    if (normal.lengthSq() === 0) return false;
    const d = furthest((at) => -across(at).dot(normal));
    const height = (at: Vector3) => Math.abs(side.copy(at).sub(from).dot(normal)) / normal.length();
    const e = furthest(height);
    const isThick = height(place(e, point)) > THICK * boxes[4 * piece + 3]!;
    const faces = isThick ? [[a, b, c], [a, b, e], [a, c, e], [b, c, e]] : [[a, b, c], ...(across(place(d, point)).dot(normal) < 0 ? [[a, b, d]] : [])];
    // As large as what is seen of the piece: of two layers one, each way.
    const hasLayers = !isThick && facing.length() < ONE_SIDED * area;
    const drawn = faces.reduce((sum, face) => sum + this.face(...(face as [number, number, number])).length(), 0) * (hasLayers ? 2 : 1);
    // Faces that lie inside a piece are not seen, however large they are together.
    const scale = factor * Math.min(Math.sqrt(area / drawn), LARGEST_SWELL);
    const inside = new Vector3();
    for (const vertex of [a, b, c, e]) inside.add(place(vertex, point));
    inside.multiplyScalar(1 / 4);
    const known = new Map<number, number>();
    const add = (corners: number[]) => {
      for (const vertex of corners) {
        let copy = known.get(vertex);
        if (copy === undefined) known.set(vertex, (copy = this.copies.add(vertex, places, boxes, 4 * piece, scale)));
        out.push(copy);
      }
    };
    for (const [p, q, r] of faces as [number, number, number][]) {
      const way = this.face(p, q, r).clone();
      const outwards = isThick ? way.dot(place(p, side).sub(inside)) : hasLayers ? 1 : way.dot(facing);
      add(outwards < 0 ? [p, r, q] : [p, q, r]);
      if (!hasLayers) continue;
      // The other side is lit by the normals of the other layer.
      const opposite = (vertex: number) => {
        place(vertex, from);
        let [least, which] = [Infinity, vertex];
        for (const other of vertices) {
          const isBack = normals[3 * other]! * way.x + normals[3 * other + 1]! * way.y + normals[3 * other + 2]! * way.z < 0;
          const distance = place(other, point).distanceToSquared(from);
          if (isBack && distance < least) [least, which] = [distance, other];
        }
        return which;
      };
      add([opposite(p), opposite(r), opposite(q)]);
    }
    return true;
  }

  /** Twice the area of a triangle, along its normal; the same vector each time. */
  private face(p: number, q: number, r: number): Vector3 {
    const { places } = this;
    side.fromArray(places, 3 * p);
    edge.fromArray(places, 3 * r).sub(side);
    return facet.fromArray(places, 3 * q).sub(side).cross(edge);
  }

  /** What hangs together; where that is large and has many triangles, as leaves on their twigs, what shares vertices, or each triangle by itself. */
  private piecesOf(level: BufferAttribute, largest: number): Pieces {
    if (this.known?.level !== level) this.known = { level, connected: connected(level, this.welded) };
    let pieces = this.boxed(level, this.known.connected);
    for (const finer of [() => connected(level, null), () => Uint32Array.from({ length: level.count / 3 }, (_, t) => t)]) {
      const { of, begins, boxes } = pieces;
      const isLarge = (piece: number) => begins[piece + 1]! - begins[piece]! > FEW_TRIANGLES && boxes[4 * piece + 3]! > largest;
      const count = begins.length - 1;
      let hasLarge = false;
      for (let piece = 0; piece < count && !hasLarge; ++piece) hasLarge = isLarge(piece);
      if (!hasLarge) break;
      pieces = this.boxed(level, renumbered(finer().map((piece, t) => (isLarge(of[t]!) ? count + piece : of[t]!))));
    }
    return pieces;
  }

  private boxed(level: BufferAttribute, of: Uint32Array): Pieces {
    const { places } = this;
    const count = of.reduce((most, piece) => Math.max(most, piece + 1), 0);
    const begins = new Uint32Array(count + 1);
    for (const piece of of) ++begins[piece + 1]!;
    for (let piece = 0; piece < count; ++piece) begins[piece + 1]! += begins[piece]!;
    const triangles = new Uint32Array(of.length);
    const filled = begins.slice();
    of.forEach((piece, t) => (triangles[filled[piece]!++] = t));
    const boxes = new Float64Array(4 * count);
    const index = level.array;
    for (let piece = 0; piece < count; ++piece) {
      box.makeEmpty();
      const { min, max } = box;
      for (let at = begins[piece]!; at < begins[piece + 1]!; ++at)
        for (let corner = 3 * triangles[at]!, end = corner + 3; corner < end; ++corner) {
          const from = 3 * index[corner]!;
          const x = places[from]!, y = places[from + 1]!, z = places[from + 2]!;
          if (x < min.x) min.x = x;
          if (y < min.y) min.y = y;
          if (z < min.z) min.z = z;
          if (x > max.x) max.x = x;
          if (y > max.y) max.y = y;
          if (z > max.z) max.z = z;
        }
      box.getCenter(point).toArray(boxes, 4 * piece);
      boxes[4 * piece + 3] = box.getSize(point).length();
    }
    return { of, triangles, begins, boxes };
  }
}

const point = new Vector3();
const side = new Vector3();
const edge = new Vector3();
const facet = new Vector3();
const box = new Box3();

function read(attribute: BufferAttribute | InterleavedBufferAttribute): Float32Array {
  const numbers = new Float32Array(3 * attribute.count);
  for (let i = 0; i < attribute.count; ++i) {
    numbers[3 * i] = attribute.getX(i);
    numbers[3 * i + 1] = attribute.getY(i);
    numbers[3 * i + 2] = attribute.getZ(i);
  }
  return numbers;
}

/** Of each vertex the first one at its place. */
function weld(places: Float32Array): Uint32Array {
  const count = places.length / 3;
  const welded = new Uint32Array(count);
  // A table with open addressing: a Map of so many places takes several times as long.
  const size = 2 ** Math.ceil(Math.log2(2 * count + 1));
  const table = new Int32Array(size).fill(-1);
  for (let vertex = 0; vertex < count; ++vertex) {
    const at = 3 * vertex;
    const x = places[at]!, y = places[at + 1]!, z = places[at + 2]!;
    let slot = (Math.imul(x, 73856093) ^ Math.imul(y, 19349663) ^ Math.imul(z, 83492791)) & (size - 1);
    let first = table[slot]!;
    while (first >= 0 && (places[3 * first] !== x || places[3 * first + 1] !== y || places[3 * first + 2] !== z)) first = table[(slot = (slot + 1) & (size - 1))]!;
    if (first < 0) table[slot] = first = vertex;
    welded[vertex] = first;
  }
  return welded;
}

/** Numbers the triangles that share vertices alike; `welded`: vertices that are one. */
function connected(level: BufferAttribute, welded: Uint32Array | null): Uint32Array {
  const corners = welded ? Uint32Array.from(level.array, (vertex) => welded[vertex]!) : Uint32Array.from(level.array);
  const parent = new Uint32Array(corners.reduce((most, vertex) => Math.max(most, vertex), 0) + 1).map((_, vertex) => vertex);
  const rootOf = (vertex: number): number => {
    while (parent[vertex] !== vertex) vertex = parent[vertex] = parent[parent[vertex]!]!;
    return vertex;
  };
  for (let i = 0; i < corners.length; i += 3)
    for (let k = 1; k < 3; ++k) parent[rootOf(corners[i + k]!)] = rootOf(corners[i]!);
  return renumbered(Uint32Array.from({ length: corners.length / 3 }, (_, t) => rootOf(corners[3 * t]!)));
}

/** The same numbers made dense, in the order in which they come. */
function renumbered(of: Uint32Array): Uint32Array {
  const numbers = new Int32Array(of.reduce((most, number) => Math.max(most, number), 0) + 1).fill(-1);
  let count = 0;
  return of.map((number) => (numbers[number]! < 0 ? (numbers[number] = count++) : numbers[number]!));
}

/** Further vertices of a geometry: copies of some of its own at other places. */
class Copies {
  private readonly sources: number[] = [];
  private readonly places: number[] = [];
  private readonly own: number;
  private readonly low: Vector3;
  private readonly high: Vector3;

  constructor(private readonly geometry: BufferGeometry) {
    this.own = geometry.getAttribute("position").count;
    if (!geometry.boundingBox) geometry.computeBoundingBox();
    this.low = geometry.boundingBox!.min;
    this.high = geometry.boundingBox!.max;
  }

  get count(): number {
    return this.sources.length;
  }

  get total(): number {
    return this.own + this.count;
  }

  /** A vertex of a piece whose middle stands in `boxes` from `at` on, and which is enlarged about it; its number. */
  add(vertex: number, places: Float32Array, boxes: Float64Array, at: number, factor: number): number {
    this.sources.push(vertex);
    for (let k = 0; k < 3; ++k) {
      const middle = boxes[at + k]!;
      // Within the part's own box, so that no box around it grows.
      this.places.push(Math.min(this.high.getComponent(k), Math.max(this.low.getComponent(k), Math.round(middle + factor * (places[3 * vertex + k]! - middle)))));
    }
    return this.total - 1;
  }

  /** The geometry with these vertices. */
  extended(): BufferGeometry {
    const result = new BufferGeometry();
    for (const [name, attribute] of Object.entries(this.geometry.attributes)) result.setAttribute(name, this.longer(attribute as Vertices));
    const position = result.getAttribute("position");
    for (let i = 0; i < this.count; ++i) position.setXYZ(this.own + i, this.places[3 * i]!, this.places[3 * i + 1]!, this.places[3 * i + 2]!);
    result.setIndex(this.geometry.index);
    result.boundingBox = this.geometry.boundingBox;
    result.boundingSphere = this.geometry.boundingSphere;
    result.userData = this.geometry.userData;
    return result;
  }

  private longer(attribute: Vertices): Vertices {
    const isInterleaved = attribute instanceof InterleavedBufferAttribute;
    const stride = isInterleaved ? attribute.data.stride : attribute.itemSize;
    const array = new (attribute.array.constructor as new (length: number) => TypedArray)(stride * this.total);
    array.set(attribute.array.subarray(0, stride * this.own) as never);
    this.sources.forEach((source, i) => array.copyWithin(stride * (this.own + i), stride * source, stride * (source + 1)));
    if (isInterleaved) return new InterleavedBufferAttribute(new InterleavedBuffer(array, stride), attribute.itemSize, attribute.offset, attribute.normalized);
    return new BufferAttribute(array, attribute.itemSize, attribute.normalized);
  }
}

function compact(index: ArrayLike<number>, vertices: number): Uint16Array | Uint32Array {
  return vertices > 65535 ? Uint32Array.from(index) : Uint16Array.from(index);
}
