// SPDX-License-Identifier: MIT
// Where a liquid's particles are (docs/decisions/0014-liquid-surface.md): their density on a grid as fine as they are apart, stored in
// blocks, and only where particles are.

/** Nodes along an edge of a block, and with one more on either side. */
export const EDGE = 8;
export const WIDE = EDGE + 2;
export const NODES = EDGE ** 3;
const BLURS = 2;

/** Density of the particles relative to the liquid's: smooth from 0 outside to about 1 inside; reuses its memory. */
export class LiquidField {
  /** Number of the first node along each axis. */
  lower = [0, 0, 0];
  /** Number of blocks along each axis, and the block at each grid place; -1: none. */
  private span = [0, 0, 0];
  private table = new Int32Array(0);
  private readonly places: number[] = [];
  /** Density that a block's own particles add to each of its nodes, with a margin. */
  private splat = new Float32Array(0);
  private density = new Float32Array(0);
  private blurred = new Float32Array(0);
  private readonly padded = new Float32Array(WIDE ** 3);

  /** `points`: x y z of each particle, m; `spacing`: edge of a cube of a particle's volume, m. */
  build(points: Float32Array, spacing: number): void {
    this.layOut(points, spacing);
    this.addParticles(points, spacing);
    this.addMargins();
    for (let round = 1; round < BLURS; ++round) {
      this.blur();
      [this.density, this.blurred] = [this.blurred, this.density];
    }
    this.blur();
  }

  /** Number of blocks. */
  get count(): number {
    return this.places.length;
  }

  /** Values of all blocks, one after the other, x first. */
  get values(): Float32Array {
    return this.blurred;
  }

  /** The numbers of a block's first node. */
  corner(block: number): [number, number, number] {
    const { lower, span } = this;
    const place = this.places[block]!;
    return [
      lower[0]! + EDGE * (place % span[0]!),
      lower[1]! + EDGE * (Math.floor(place / span[0]!) % span[1]!),
      lower[2]! + EDGE * Math.floor(place / (span[0]! * span[1]!)),
    ];
  }

  /** The value at a node, counted from the first. */
  valueAt(x: number, y: number, z: number): number {
    const { span } = this;
    const block = this.table[(x >> 3) + span[0]! * ((y >> 3) + span[1]! * (z >> 3))]!;
    return block < 0 ? 0 : this.blurred[block * NODES + (x & 7) + EDGE * ((y & 7) + EDGE * (z & 7))]!;
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
      this.blurred = new Float32Array(room * NODES);
    } else {
      this.splat.fill(0, 0, count * WIDE ** 3);
    }
  }

  /** The block beside another, or -1. */
  neighbour(block: number, dx: number, dy: number, dz: number): number {
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

  /** Copies a block's values and one row of those around it; `none` where there is no block. */
  gather<Values extends Float32Array | Int32Array>(block: number, values: Values, padded: Values, none: number): Values {
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
          for (let x = first[a]!; x <= last[a]!; ++x) padded[target + x] = other < 0 ? none : values[source + x]!;
        }
      }
    }
    return padded;
  }

  // Smooths the density by (1 2 1)/4 along each axis.
  private blur(): void {
    const plane = WIDE * WIDE;
    for (let block = 0; block < this.places.length; ++block) {
      const field = this.gather(block, this.density, this.padded, 0);
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
          for (let x = 0; x < EDGE; ++x) this.blurred[base + x + EDGE * (y + EDGE * z)] = field[x + 1 + WIDE * (y + 1 + WIDE * (z + 1))]!;
    }
  }
}
