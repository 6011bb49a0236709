// SPDX-License-Identifier: MIT
import { BufferAttribute, BufferGeometry, type InterleavedBufferAttribute, Matrix3, type Matrix4, Vector3 } from "three";

const MOST_PASSES = 8;
const MOST_VERTICES = 60_000;
/** More than there are ever vertices, so that the numbers of two make one key. */
export const EDGE_KEY_STEP = 2 ** 26;

/** The numbers of one attribute, `size` for each vertex. */
export interface Numbers {
  size: number;
  values: number[];
}

/** A refined geometry, and the lists of triangles on the way to it, the coarsest first. */
export interface Refined {
  geometry: BufferGeometry;
  stages: number[][];
}

/**
 * A copy of a geometry transformed by `matrix`, in plain floats, with edges longer than `longest` halved until none is, so that a
 * flat triangle can bend. An edge is halved at the same point for all triangles that have it.
 */
export function refine(geometry: BufferGeometry, matrix: Matrix4, longest: number): Refined {
  const placed = geometry.clone();
  if (!placed.getAttribute("normal")) placed.computeVertexNormals();
  const attributes = numbersOf(placed);
  placeAll(attributes.get("position")!, (vector) => vector.applyMatrix4(matrix));
  const turn = new Matrix3().getNormalMatrix(matrix);
  placeAll(attributes.get("normal")!, (vector) => vector.applyNormalMatrix(turn));
  let triangles = placed.index ? Array.from(placed.index.array) : Array.from({ length: placed.getAttribute("position").count }, (_, i) => i);
  placed.dispose();
  const stages: number[][] = [];
  for (let pass = 0; pass < MOST_PASSES; ++pass) {
    const split = halve(triangles, attributes, longest);
    if (!split) break;
    stages.push(triangles);
    triangles = split;
  }
  // The mean of two unit vectors is shorter than 1.
  placeAll(attributes.get("normal")!, (vector) => vector.normalize());
  return { geometry: geometryOf(attributes, triangles), stages };
}

export function numbersOf(geometry: BufferGeometry): Map<string, Numbers> {
  return new Map(Object.entries(geometry.attributes).map(([name, attribute]) => [name, read(attribute)]));
}

export function geometryOf(attributes: Map<string, Numbers>, triangles: number[]): BufferGeometry {
  const geometry = new BufferGeometry();
  for (const [name, { size, values }] of attributes) geometry.setAttribute(name, new BufferAttribute(new Float32Array(values), size));
  geometry.setIndex(triangles);
  return geometry;
}

/** Adds a vertex between two, at this share of the way from `a` to `b`; returns its number. */
export function addBetween(attributes: Map<string, Numbers>, a: number, b: number, share: number): number {
  for (const { size, values } of attributes.values())
    for (let k = 0; k < size; ++k) values.push((1 - share) * values[size * a + k]! + share * values[size * b + k]!);
  return attributes.get("position")!.values.length / 3 - 1;
}

// Converts quantised numbers to floats.
function read(attribute: BufferAttribute | InterleavedBufferAttribute): Numbers {
  const values: number[] = [];
  for (let i = 0; i < attribute.count; ++i)
    for (let k = 0; k < attribute.itemSize; ++k) values.push(attribute.getComponent(i, k));
  return { size: attribute.itemSize, values };
}

function placeAll({ values }: Numbers, place: (vector: Vector3) => Vector3): void {
  const vector = new Vector3();
  for (let at = 0; at < values.length; at += 3) place(vector.fromArray(values, at)).toArray(values, at);
}

/** Divides each triangle according to its edges that are too long; null where none is. */
function halve(triangles: number[], attributes: Map<string, Numbers>, longest: number): number[] | null {
  const { values } = attributes.get("position")!;
  const isLong = (a: number, b: number) => {
    const x = values[3 * a]! - values[3 * b]!;
    const y = values[3 * a + 1]! - values[3 * b + 1]!;
    const z = values[3 * a + 2]! - values[3 * b + 2]!;
    return x * x + y * y + z * z > longest * longest;
  };
  const middles = new Map<number, number>();
  const middle = (a: number, b: number) => {
    const key = Math.min(a, b) * EDGE_KEY_STEP + Math.max(a, b);
    let found = middles.get(key);
    if (found === undefined) {
      found = addBetween(attributes, a, b, 0.5);
      middles.set(key, found);
    }
    return found;
  };
  const out: number[] = [];
  for (let t = 0; t < triangles.length; t += 3) {
    if (values.length / 3 > MOST_VERTICES) return null;
    divide(triangles[t]!, triangles[t + 1]!, triangles[t + 2]!, isLong, middle, out);
  }
  return middles.size > 0 ? out : null;
}

/** Appends a triangle to `out`, divided at the new vertices `point(from, to)` of its edges that are cut. */
export function divide(a: number, b: number, c: number, isCut: (from: number, to: number) => boolean, point: (from: number, to: number) => number, out: number[]): void {
  const cut = [isCut(a, b), isCut(b, c), isCut(c, a)];
  const count = cut.filter(Boolean).length;
  // Rotated so that the edge that differs from the two others comes last.
  const odd = count === 1 ? cut.indexOf(true) : count === 2 ? cut.indexOf(false) : 2;
  if (odd === 0) [a, b, c] = [b, c, a];
  else if (odd === 1) [a, b, c] = [c, a, b];
  if (count === 0) {
    out.push(a, b, c);
  } else if (count === 1) {
    const ca = point(c, a);
    out.push(a, b, ca, ca, b, c);
  } else if (count === 2) {
    const [ab, bc] = [point(a, b), point(b, c)];
    out.push(ab, b, bc, a, ab, bc, a, bc, c);
  } else {
    const [ab, bc, ca] = [point(a, b), point(b, c), point(c, a)];
    out.push(a, ab, ca, ab, b, bc, ca, bc, c, ab, bc, ca);
  }
}
