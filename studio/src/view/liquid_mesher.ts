// SPDX-License-Identifier: MIT
// The surface of a liquid from its particles (docs/decisions/0014-liquid-surface.md): their density on a grid, and the surface
// where it is LEVEL of the liquid's, as a mesh of quads with one vertex in each cell that the surface crosses.

/** Nodes along an edge of a block, and with one more on either side. */
const EDGE = 8;
const WIDE = EDGE + 2;
const NODES = EDGE ** 3;
/** Fraction of the liquid's density at which the surface is drawn. */
const LEVEL = 0.42;
/** Fractions of the displacement to their neighbours' mean that vertices move: first inwards, then back (G. Taubin, 1995). */
const SMOOTHING = [0.5, -0.52, 0.5, -0.52, 0.5];
/** A drop is an octahedron with each face divided once. */
const DROP = dropShape();
const MOST_DROPS = 4000;

/** Triangles, counter-clockwise seen from outside; world, m. */
export interface LiquidMesh {
  positions: Float32Array;
  normals: Float32Array;
  indices: Uint32Array;
  /** Enclosed volume, m³, and surface area, m². */
  volume: number;
  area: number;
}

/** Makes meshes from particles; reuses its memory for the next mesh. */
export class LiquidMesher {
  private lower = [0, 0, 0];
  /** Number of blocks along each axis, and the block at each grid place; -1: none. */
  private span = [0, 0, 0];
  private table = new Int32Array(0);
  private places: number[] = [];
  /** Density that a block's own particles add to each of its nodes, with a margin. */
  private splat = new Float32Array(0);
  private density = new Float32Array(0);
  private smooth = new Float32Array(0);
  private vertexOf = new Int32Array(0);
  private readonly positions: number[] = [];
  private readonly indices: number[] = [];
  private readonly padded = new Float32Array(WIDE ** 3);

  /** `points`: x y z of each particle, m; `spacing`: edge of a cube of a particle's volume, m. */
  build(points: Float32Array, spacing: number): LiquidMesh {
    this.positions.length = this.indices.length = 0;
    if (points.length > 0) {
      this.layOut(points, spacing);
      this.addParticles(points, spacing);
      this.addMargins();
      this.blur();
      this.makeVertices(spacing);
      this.makeQuads();
    }
    const body = this.positions.length;
    const positions = new Float32Array(body + 3 * DROP.corners.length * this.countDrops(points, spacing));
    positions.set(this.positions);
    for (const share of SMOOTHING) smoothen(positions, body, this.indices, share);
    this.addDrops(points, spacing, positions, body);
    const indices = new Uint32Array(this.indices);
    return { positions, normals: normalsOf(positions, indices), indices, ...measure(positions, indices) };
  }

  private layOut(points: Float32Array, spacing: number): void {
    const least = [Infinity, Infinity, Infinity];
    const most = [-Infinity, -Infinity, -Infinity];
    for (let at = 0; at < points.length; ++at) {
      const axis = at % 3;
      if (points[at]! < least[axis]!) least[axis] = points[at]!;
      if (points[at]! > most[axis]!) most[axis] = points[at]!;
    }
    // One more block on either side than contain particles, so that every margin has its block.
    this.lower = least.map((x) => (Math.floor(x / spacing / EDGE) - 1) * EDGE);
    this.span = most.map((x, axis) => Math.floor((x / spacing - this.lower[axis]!) / EDGE) + 2);
    const count = this.span[0]! * this.span[1]! * this.span[2]!;
    if (this.table.length < count) this.table = new Int32Array(count);
    this.table.fill(-1, 0, count);
    this.places.length = 0;
  }

  private block(place: number): number {
    let block = this.table[place]!;
    if (block >= 0) return block;
    block = this.table[place] = this.places.push(place) - 1;
    return block;
  }

  // Adds quadratic B-splines around each particle.
  private addParticles(points: Float32Array, spacing: number): void {
    const { lower, span } = this;
    const row = span[0]!;
    const layer = span[0]! * span[1]!;
    // First find the blocks: those of each particle and their neighbours.
    const blockOf = new Int32Array(points.length / 3);
    for (let p = 0, at = 0; at < points.length; ++p, at += 3) {
      const x = Math.round(points[at]! / spacing - lower[0]!);
      const y = Math.round(points[at + 1]! / spacing - lower[1]!);
      const z = Math.round(points[at + 2]! / spacing - lower[2]!);
      const place = (x >> 3) + row * (y >> 3) + layer * (z >> 3);
      blockOf[p] = this.block(place);
      const near = (i: number): number => ((i & 7) < 2 ? -1 : (i & 7) > 5 ? 1 : 0);
      const nx = near(x);
      const ny = near(y);
      const nz = near(z);
      if (nx) this.block(place + nx);
      if (ny) this.block(place + ny * row);
      if (nz) this.block(place + nz * layer);
      if (nx && ny) this.block(place + nx + ny * row);
      if (ny && nz) this.block(place + ny * row + nz * layer);
      if (nx && nz) this.block(place + nx + nz * layer);
      if (nx && ny && nz) this.block(place + nx + ny * row + nz * layer);
    }
    this.reserve();
    const { splat } = this;
    for (let p = 0, at = 0; at < points.length; ++p, at += 3) {
      const x = points[at]! / spacing - lower[0]!;
      const y = points[at + 1]! / spacing - lower[1]!;
      const z = points[at + 2]! / spacing - lower[2]!;
      const ix = Math.round(x);
      const iy = Math.round(y);
      const iz = Math.round(z);
      const dx = x - ix;
      const dy = y - iy;
      const dz = z - iz;
      const x0 = 0.5 * (0.5 - dx) ** 2;
      const x1 = 0.75 - dx * dx;
      const x2 = 0.5 * (0.5 + dx) ** 2;
      // The margin's node has number 0, so the stencil begins at the node's own number.
      let node = blockOf[p]! * WIDE ** 3 + (ix & 7) + WIDE * ((iy & 7) + WIDE * (iz & 7));
      for (let c = 0; c < 3; ++c) {
        const wz = c === 0 ? 0.5 * (0.5 - dz) ** 2 : c === 1 ? 0.75 - dz * dz : 0.5 * (0.5 + dz) ** 2;
        for (let b = 0; b < 3; ++b) {
          const w = wz * (b === 0 ? 0.5 * (0.5 - dy) ** 2 : b === 1 ? 0.75 - dy * dy : 0.5 * (0.5 + dy) ** 2);
          splat[node]! += w * x0;
          splat[node + 1]! += w * x1;
          splat[node + 2]! += w * x2;
          node += WIDE;
        }
        node += WIDE * (WIDE - 3);
      }
    }
  }

  private reserve(): void {
    const count = this.places.length;
    if (this.density.length < count * NODES) {
      const room = Math.ceil(1.3 * count);
      this.splat = new Float32Array(room * WIDE ** 3);
      this.density = new Float32Array(room * NODES);
      this.smooth = new Float32Array(room * NODES);
      this.vertexOf = new Int32Array(room * NODES);
    } else {
      this.splat.fill(0, 0, count * WIDE ** 3);
    }
  }

  private neighbour(block: number, dx: number, dy: number, dz: number): number {
    const place = this.places[block]!;
    const { span } = this;
    const x = (place % span[0]!) + dx;
    const y = (Math.floor(place / span[0]!) % span[1]!) + dy;
    const z = Math.floor(place / (span[0]! * span[1]!)) + dz;
    if (x < 0 || y < 0 || z < 0 || x >= span[0]! || y >= span[1]! || z >= span[2]!) return -1;
    return this.table[x + span[0]! * (y + span[1]! * z)]!;
  }

  // Adds a block's margins to the nodes of its neighbours.
  private addMargins(): void {
    const { splat, density } = this;
    // For a neighbour at -1, 0, 1: first and last of the own nodes, and the offset to the neighbour's number of the same node.
    const first = [0, 0, EDGE - 1];
    const last = [0, EDGE - 1, EDGE - 1];
    const shift = [EDGE + 1, 1, 1 - EDGE];
    for (let block = 0; block < this.places.length; ++block) {
      const base = block * NODES;
      density.fill(0, base, base + NODES);
      for (let n = 0; n < 27; ++n) {
        const a = n % 3;
        const b = Math.floor(n / 3) % 3;
        const c = Math.floor(n / 9);
        const other = n === 13 ? block : this.neighbour(block, a - 1, b - 1, c - 1);
        if (other < 0) continue;
        const from = other * WIDE ** 3;
        for (let z = first[c]!; z <= last[c]!; ++z) {
          for (let y = first[b]!; y <= last[b]!; ++y) {
            const source = from + WIDE * (y + shift[b]! + WIDE * (z + shift[c]!)) + shift[a]!;
            const target = base + EDGE * (y + EDGE * z);
            for (let x = first[a]!; x <= last[a]!; ++x) density[target + x]! += splat[source + x]!;
          }
        }
      }
    }
  }

  /** A block's values and one row of those around it; 0 where there is no block. */
  private gather(block: number, values: Float32Array): Float32Array {
    const { padded } = this;
    const first = [0, 1, EDGE + 1];
    const last = [0, EDGE, EDGE + 1];
    const shift = [EDGE - 1, -1, -1 - EDGE];
    for (let n = 0; n < 27; ++n) {
      const a = n % 3;
      const b = Math.floor(n / 3) % 3;
      const c = Math.floor(n / 9);
      const other = n === 13 ? block : this.neighbour(block, a - 1, b - 1, c - 1);
      for (let z = first[c]!; z <= last[c]!; ++z) {
        for (let y = first[b]!; y <= last[b]!; ++y) {
          const target = WIDE * (y + WIDE * z);
          const source = other * NODES + EDGE * (y + shift[b]! + EDGE * (z + shift[c]!)) + shift[a]!;
          for (let x = first[a]!; x <= last[a]!; ++x) padded[target + x] = other < 0 ? 0 : values[source + x]!;
        }
      }
    }
    return padded;
  }

  // Smooths the density by (1 2 1)/4 along each axis.
  private blur(): void {
    const plane = WIDE * WIDE;
    for (let block = 0; block < this.places.length; ++block) {
      const field = this.gather(block, this.density);
      // Each axis also processes the rows of the margin that a later axis needs.
      for (const [step, side, other] of [
        [1, WIDE, plane],
        [WIDE, 1, plane],
        [plane, 1, WIDE],
      ] as const) {
        for (let i = 0; i < WIDE; ++i) {
          for (let k = 0; k < WIDE; ++k) {
            let at = i * side + k * other;
            let before = field[at]!;
            for (let n = 0; n < EDGE; ++n) {
              at += step;
              const own = field[at]!;
              field[at] = 0.25 * before + 0.5 * own + 0.25 * field[at + step]!;
              before = own;
            }
          }
        }
      }
      const base = block * NODES;
      for (let z = 0; z < EDGE; ++z)
        for (let y = 0; y < EDGE; ++y)
          for (let x = 0; x < EDGE; ++x) this.smooth[base + x + EDGE * (y + EDGE * z)] = field[x + 1 + WIDE * (y + 1 + WIDE * (z + 1))]!;
    }
  }

  // In each cell with nodes on both sides of the surface: a vertex at the mean of the points where its edges cross it.
  private makeVertices(spacing: number): void {
    const { positions, vertexOf, span } = this;
    const corner = [0, 1, WIDE, WIDE + 1, WIDE * WIDE, WIDE * WIDE + 1, WIDE * WIDE + WIDE, WIDE * WIDE + WIDE + 1];
    const value = new Float64Array(8);
    for (let block = 0; block < this.places.length; ++block) {
      const field = this.gather(block, this.smooth);
      const place = this.places[block]!;
      const x0 = this.lower[0]! + EDGE * (place % span[0]!);
      const y0 = this.lower[1]! + EDGE * (Math.floor(place / span[0]!) % span[1]!);
      const z0 = this.lower[2]! + EDGE * Math.floor(place / (span[0]! * span[1]!));
      for (let node = 0; node < NODES; ++node) {
        const x = node & 7;
        const y = (node >> 3) & 7;
        const z = node >> 6;
        const at = x + 1 + WIDE * (y + 1 + WIDE * (z + 1));
        vertexOf[block * NODES + node] = -1;
        let inside = 0;
        for (let c = 0; c < 8; ++c) {
          value[c] = field[at + corner[c]!]! - LEVEL;
          if (value[c]! > 0) inside |= 1 << c;
        }
        if (inside === 0 || inside === 255) continue;
        let sx = 0;
        let sy = 0;
        let sz = 0;
        let count = 0;
        for (let c = 0; c < 8; ++c) {
          for (let axis = 1; axis < 8; axis <<= 1) {
            const d = c | axis;
            if (d === c || value[c]! > 0 === value[d]! > 0) continue;
            const share = value[c]! / (value[c]! - value[d]!);
            sx += (c & 1) + (axis === 1 ? share : 0);
            sy += ((c >> 1) & 1) + (axis === 2 ? share : 0);
            sz += (c >> 2) + (axis === 4 ? share : 0);
            ++count;
          }
        }
        vertexOf[block * NODES + node] = positions.length / 3;
        positions.push((x0 + x + sx / count) * spacing, (y0 + y + sy / count) * spacing, (z0 + z + sz / count) * spacing);
      }
    }
  }

  // Around each edge of the grid that crosses the surface: a quad of the vertices of the four cells around it.
  private makeQuads(): void {
    const { smooth, indices } = this;
    const step = [1, EDGE, EDGE * EDGE];
    for (let block = 0; block < this.places.length; ++block) {
      const above = [this.neighbour(block, 1, 0, 0), this.neighbour(block, 0, 1, 0), this.neighbour(block, 0, 0, 1)];
      for (let node = 0; node < NODES; ++node) {
        const value = smooth[block * NODES + node]!;
        for (let axis = 0; axis < 3; ++axis) {
          let next = 0;
          if (((node >> (3 * axis)) & 7) < EDGE - 1) {
            next = smooth[block * NODES + node + step[axis]!]!;
          } else {
            const other = above[axis]!;
            if (other >= 0) next = smooth[other * NODES + node - (EDGE - 1) * step[axis]!]!;
          }
          if (value > LEVEL === next > LEVEL) continue;
          const number = [node & 7, (node >> 3) & 7, node >> 6];
          const u = (axis + 1) % 3;
          const v = (axis + 2) % 3;
          const a = this.vertex(block, number, -1, -1, u, v);
          const b = this.vertex(block, number, 0, -1, u, v);
          const c = this.vertex(block, number, 0, 0, u, v);
          const d = this.vertex(block, number, -1, 0, u, v);
          if (a < 0 || b < 0 || c < 0 || d < 0) continue;
          if (value > LEVEL) indices.push(a, b, c, a, c, d);
          else indices.push(a, c, b, a, d, c);
        }
      }
    }
  }

  private vertex(block: number, number: readonly number[], du: number, dv: number, u: number, v: number): number {
    const at = [number[0]!, number[1]!, number[2]!];
    at[u]! += du;
    at[v]! += dv;
    let own = block;
    if (at[u]! < 0 || at[v]! < 0) {
      const over = [0, 0, 0];
      if (at[u]! < 0) over[u] = -1;
      if (at[v]! < 0) over[v] = -1;
      own = this.neighbour(block, over[0]!, over[1]!, over[2]!);
      if (own < 0) return -1;
    }
    return this.vertexOf[own * NODES + (at[0]! & 7) + EDGE * ((at[1]! & 7) + EDGE * (at[2]! & 7))]!;
  }

  /** Whether none of the 27 nodes around the particle is inside the surface. */
  private isDrop(points: Float32Array, at: number, spacing: number): boolean {
    const { lower } = this;
    const x = Math.round(points[at]! / spacing - lower[0]!);
    const y = Math.round(points[at + 1]! / spacing - lower[1]!);
    const z = Math.round(points[at + 2]! / spacing - lower[2]!);
    if (this.valueAt(x, y, z) > LEVEL) return false;
    for (let n = 0; n < 27; ++n) {
      if (this.valueAt(x + (n % 3) - 1, y + (Math.floor(n / 3) % 3) - 1, z + Math.floor(n / 9) - 1) > LEVEL) return false;
    }
    return true;
  }

  private valueAt(x: number, y: number, z: number): number {
    const { span } = this;
    const block = this.table[(x >> 3) + span[0]! * ((y >> 3) + span[1]! * (z >> 3))]!;
    return block < 0 ? 0 : this.smooth[block * NODES + (x & 7) + EDGE * ((y & 7) + EDGE * (z & 7))]!;
  }

  private countDrops(points: Float32Array, spacing: number): number {
    let count = 0;
    for (let at = 0; at < points.length && count < MOST_DROPS; at += 3) if (this.isDrop(points, at, spacing)) ++count;
    return count;
  }

  private addDrops(points: Float32Array, spacing: number, positions: Float32Array, first: number): void {
    const radius = Math.cbrt(3 / (4 * Math.PI)) * spacing;
    let to = first;
    for (let at = 0; at < points.length && to < positions.length; at += 3) {
      if (!this.isDrop(points, at, spacing)) continue;
      for (const index of DROP.faces) this.indices.push(to / 3 + index);
      for (const corner of DROP.corners)
        for (let axis = 0; axis < 3; ++axis) positions[to++] = points[at + axis]! + radius * corner[axis]!;
    }
  }
}

/** Moves the vertices up to `end` by a fraction `share` of the displacement to the mean of their neighbours. */
function smoothen(positions: Float32Array, end: number, indices: readonly number[], share: number): void {
  const sum = new Float32Array(end);
  const count = new Uint8Array(end / 3);
  // Each edge of the net is in two triangles in opposite directions, the diagonals too: weights are those of a triangle mesh.
  for (let at = 0; at < indices.length; at += 3) {
    for (let k = 0; k < 3; ++k) {
      const from = indices[at + k]!;
      const to = indices[at + ((k + 1) % 3)]!;
      sum[3 * from]! += positions[3 * to]!;
      sum[3 * from + 1]! += positions[3 * to + 1]!;
      sum[3 * from + 2]! += positions[3 * to + 2]!;
      ++count[from]!;
    }
  }
  for (let at = 0; at < end; ++at) {
    const neighbours = count[Math.floor(at / 3)]!;
    if (neighbours > 0) positions[at]! += share * (sum[at]! / neighbours - positions[at]!);
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
  for (let at = 0; at < normals.length; at += 3) {
    const size = Math.hypot(normals[at]!, normals[at + 1]!, normals[at + 2]!) || 1;
    for (let axis = 0; axis < 3; ++axis) normals[at + axis]! /= size;
  }
  return normals;
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

function measure(positions: Float32Array, indices: Uint32Array): { volume: number; area: number } {
  let volume = 0;
  let area = 0;
  for (let at = 0; at < indices.length; at += 3) {
    const [nx, ny, nz] = faceNormal(positions, indices, at);
    const a = 3 * indices[at]!;
    area += Math.hypot(nx, ny, nz) / 2;
    volume += (positions[a]! * nx + positions[a + 1]! * ny + positions[a + 2]! * nz) / 6;
  }
  return { volume, area };
}

function dropShape(): { corners: number[][]; faces: number[] } {
  const corners = [
    [1, 0, 0],
    [-1, 0, 0],
    [0, 1, 0],
    [0, -1, 0],
    [0, 0, 1],
    [0, 0, -1],
  ];
  const middles = new Map<number, number>();
  const middle = (a: number, b: number): number => {
    const key = Math.min(a, b) * 6 + Math.max(a, b);
    const known = middles.get(key);
    if (known !== undefined) return known;
    const at = corners.push(corners[a]!.map((x, axis) => (x + corners[b]![axis]!) * Math.SQRT1_2)) - 1;
    middles.set(key, at);
    return at;
  };
  const faces: number[] = [];
  for (const x of [0, 1])
    for (const y of [2, 3])
      for (const z of [4, 5]) {
        const isEven = (x + y + z) % 2 === 0;
        const [a, b, c] = isEven ? [x, y, z] : [x, z, y];
        const [ab, bc, ca] = [middle(a!, b!), middle(b!, c!), middle(c!, a!)];
        faces.push(a!, ab, ca, b!, bc, ab, c!, ca, bc, ab, bc, ca);
      }
  return { corners, faces };
}
