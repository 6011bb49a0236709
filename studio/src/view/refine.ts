// SPDX-License-Identifier: MIT
import { BufferAttribute, BufferGeometry, type InterleavedBufferAttribute, Matrix3, type Matrix4, Vector3 } from "three";

const MOST_PASSES = 8;
const MOST_VERTICES = 60_000;
/** More than there are ever vertices, so that two numbers make one key. */
const KEY_STEP = 2 ** 26;

interface Numbers {
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
  const attributes = new Map<string, Numbers>();
  for (const [name, attribute] of Object.entries(placed.attributes)) attributes.set(name, read(attribute));
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

  const refined = new BufferGeometry();
  for (const [name, { size, values }] of attributes) refined.setAttribute(name, new BufferAttribute(new Float32Array(values), size));
  refined.setIndex(triangles);
  return { geometry: refined, stages };
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
    const key = Math.min(a, b) * KEY_STEP + Math.max(a, b);
    let found = middles.get(key);
    if (found === undefined) {
      found = values.length / 3;
      middles.set(key, found);
      for (const one of attributes.values())
        for (let k = 0; k < one.size; ++k) one.values.push((one.values[one.size * a + k]! + one.values[one.size * b + k]!) / 2);
    }
    return found;
  };
  const out: number[] = [];
  for (let t = 0; t < triangles.length; t += 3) {
    if (values.length / 3 > MOST_VERTICES) return null;
    let [a, b, c] = [triangles[t]!, triangles[t + 1]!, triangles[t + 2]!];
    const long = [isLong(a, b), isLong(b, c), isLong(c, a)];
    const count = long.filter(Boolean).length;
    // Rotated so that the edge that differs from the two others comes last.
    const odd = count === 1 ? long.indexOf(true) : count === 2 ? long.indexOf(false) : 2;
    if (odd === 0) [a, b, c] = [b, c, a];
    else if (odd === 1) [a, b, c] = [c, a, b];
    if (count === 0) {
      out.push(a, b, c);
    } else if (count === 1) {
      const ca = middle(c, a);
      out.push(a, b, ca, ca, b, c);
    } else if (count === 2) {
      const [ab, bc] = [middle(a, b), middle(b, c)];
      out.push(ab, b, bc, a, ab, bc, a, bc, c);
    } else {
      const [ab, bc, ca] = [middle(a, b), middle(b, c), middle(c, a)];
      out.push(a, ab, ca, ab, b, bc, ca, bc, c, ab, bc, ca);
    }
  }
  return middles.size > 0 ? out : null;
}
