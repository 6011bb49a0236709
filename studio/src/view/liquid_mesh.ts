// SPDX-License-Identifier: MIT
// The work on a liquid's mesh after its net has been made: normals, and the volume of its particles.

/** How often each normal is replaced by the mean of it and its neighbours'. */
const NORMAL_SMOOTHINGS = 2;
/** Rings of vertices around a film's rim, whose normals run along the film. */
const RINGS = 3;
/** How often the surface is moved to its volume: its area changes on the way. */
const MOVES = 2;

/** Triangles, counter-clockwise seen from outside; world, m. */
export interface LiquidMesh {
  positions: Float32Array;
  normals: Float32Array;
  indices: Uint32Array;
  /** How thick the liquid is below each vertex, against its normal, m. */
  thickness: Float32Array;
  /** Enclosed volume, m³, and surface area, m². */
  volume: number;
  area: number;
}

/** The neighbours of each vertex, one vertex after the other. */
export class Neighbours {
  private readonly first: Int32Array;
  private readonly all: Int32Array;

  /** Each edge of a closed net is in two triangles in opposite directions, and gives each of its ends a neighbour. */
  constructor(
    private readonly count: number,
    indices: Uint32Array,
  ) {
    this.first = new Int32Array(count + 1);
    this.all = new Int32Array(indices.length);
    const { first, all } = this;
    for (let at = 0; at < indices.length; ++at) ++first[indices[at]!]!;
    for (let vertex = 0, sum = 0; vertex <= count; ++vertex) first[vertex] = sum += first[vertex]!;
    // Filled from behind, so that each first ends where its vertex begins.
    for (let at = 0; at < indices.length; at += 3) {
      const [a, b, c] = [indices[at]!, indices[at + 1]!, indices[at + 2]!];
      all[--first[a]!] = b;
      all[--first[b]!] = c;
      all[--first[c]!] = a;
    }
  }

  /** The least of each vertex's value and its neighbours'. */
  least(values: Float32Array): Float32Array {
    const { first, all } = this;
    const least = values.slice();
    for (let vertex = 0; vertex < this.count; ++vertex)
      for (let at = first[vertex]!; at < first[vertex + 1]!; ++at) if (values[all[at]!]! < least[vertex]!) least[vertex] = values[all[at]!]!;
    return least;
  }

  /** The mean of each vertex's vector and the mean of its neighbours'. */
  mean(vectors: Float32Array): Float32Array {
    const { first, all } = this;
    const means = new Float32Array(vectors.length);
    for (let vertex = 0; vertex < this.count; ++vertex) {
      const begin = first[vertex]!;
      const end = first[vertex + 1]!;
      let [x, y, z] = [0, 0, 0];
      for (let at = begin; at < end; ++at) {
        const other = 3 * all[at]!;
        x += vectors[other]!;
        y += vectors[other + 1]!;
        z += vectors[other + 2]!;
      }
      const own = 3 * vertex;
      const part = end > begin ? 1 / (end - begin) : 0;
      means[own] = 0.5 * (vectors[own]! + part * x);
      means[own + 1] = 0.5 * (vectors[own + 1]! + part * y);
      means[own + 2] = 0.5 * (vectors[own + 2]! + part * z);
    }
    return means;
  }
}

/** The least of the values around each vertex, as far as RINGS edges away. */
export function leastAround(values: Float32Array, neighbours: Neighbours): Float32Array {
  let least = values;
  for (let ring = 0; ring < RINGS; ++ring) least = neighbours.least(least);
  return least;
}

/** Smooth normals of a closed net. */
export function smoothNormals(net: Float32Array, indices: Uint32Array, neighbours: Neighbours): Float32Array {
  let normals = normalsOf(net, indices);
  for (let round = 0; round < NORMAL_SMOOTHINGS; ++round) normals = neighbours.mean(normals);
  normalize(normals);
  return normals;
}

/** Moves a closed surface against its normals until it encloses `volume`; by no more than `most`. */
export function moveInwards(positions: Float32Array, normals: Float32Array, indices: Uint32Array, volume: number, most: number): void {
  let depth = 0;
  for (let round = 0; round < MOVES; ++round) {
    const { volume: present, area } = measure(positions, indices);
    if (area === 0) return;
    const step = Math.min(Math.max((present - volume) / area, -depth), most - depth);
    depth += step;
    // A surface parallel to another has its normals.
    for (let at = 0; at < positions.length; ++at) positions[at]! -= step * normals[at]!;
  }
}

function normalsOf(positions: Float32Array, indices: Uint32Array): Float32Array {
  const normals = new Float32Array(positions.length);
  for (let at = 0; at < indices.length; at += 3) {
    const [nx, ny, nz] = faceNormal(positions, indices, at);
    for (let k = 0; k < 3; ++k) {
      const vertex = 3 * indices[at + k]!;
      normals[vertex]! += nx;
      normals[vertex + 1]! += ny;
      normals[vertex + 2]! += nz;
    }
  }
  normalize(normals);
  return normals;
}

function normalize(vectors: Float32Array): void {
  for (let at = 0; at < vectors.length; at += 3) {
    const [x, y, z] = [vectors[at]!, vectors[at + 1]!, vectors[at + 2]!];
    const scale = 1 / (Math.sqrt(x * x + y * y + z * z) || 1);
    vectors[at]! *= scale;
    vectors[at + 1]! *= scale;
    vectors[at + 2]! *= scale;
  }
}

/** A normal whose length is twice the triangle's area. */
function faceNormal(p: Float32Array, indices: Uint32Array, at: number): [number, number, number] {
  const a = 3 * indices[at]!;
  const b = 3 * indices[at + 1]!;
  const c = 3 * indices[at + 2]!;
  const ux = p[b]! - p[a]!;
  const uy = p[b + 1]! - p[a + 1]!;
  const uz = p[b + 2]! - p[a + 2]!;
  const vx = p[c]! - p[a]!;
  const vy = p[c + 1]! - p[a + 1]!;
  const vz = p[c + 2]! - p[a + 2]!;
  return [uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx];
}

export function measure(positions: Float32Array, indices: Uint32Array): { volume: number; area: number } {
  let volume = 0;
  let area = 0;
  for (let at = 0; at < indices.length; at += 3) {
    const [nx, ny, nz] = faceNormal(positions, indices, at);
    const a = 3 * indices[at]!;
    area += Math.sqrt(nx * nx + ny * ny + nz * nz) / 2;
    volume += (positions[a]! * nx + positions[a + 1]! * ny + positions[a + 2]! * nz) / 6;
  }
  return { volume, area };
}
