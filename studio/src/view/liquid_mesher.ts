// SPDX-License-Identifier: MIT
// The surface of a liquid from its particles (docs/decisions/0014-liquid-surface.md): where their field is LEVEL, as a mesh of quads
// with one vertex in each cell that the surface crosses.
import { LiquidField, NODES, WIDE } from "./liquid_field";
import { leastAround, type LiquidMesh, measure, moveInwards, Neighbours, smoothNormals } from "./liquid_mesh";

/** Density at which the net is made: far out, so that thin films and what lies in clumps are whole. */
const LEVEL = 0.15;
/** The density falls off in a curve: fractions of an edge follow from (density − LEVEL)/(density + BEND), which falls off in a line. */
const BEND = 0.3;
/** How far it is moved inwards to the particles' volume at most, in grid steps. */
const MOST_INWARDS = 1.3;
/** Density where the liquid ends. */
const HALF = 0.5;
/** A drop is an octahedron with each face divided once. */
const DROP = dropShape();
const MOST_DROPS = 4000;

/** Makes meshes from particles; reuses its memory for the next mesh. */
export class LiquidMesher {
  private readonly field = new LiquidField();
  private vertexOf = new Int32Array(0);
  private vertices = new Float32Array(0);
  private vertexCount = 0;
  private indices = new Uint32Array(0);
  private indexCount = 0;
  private readonly padded = new Float32Array(WIDE ** 3);
  private readonly paddedVertices = new Int32Array(WIDE ** 3);

  /** `points`: x y z of each particle, m; `spacing`: edge of a cube of a particle's volume, m. */
  build(points: Float32Array, spacing: number): LiquidMesh {
    this.vertexCount = this.indexCount = 0;
    let drops: number[] = [];
    if (points.length > 0) {
      this.field.build(points, spacing);
      this.makeVertices(spacing);
      this.makeQuads();
      drops = this.findDrops(points, spacing);
    }
    const net = this.indices.subarray(0, this.indexCount);
    const held = (points.length / 3 - drops.length) * spacing ** 3;
    const body = this.vertices.subarray(0, 3 * this.vertexCount);
    const neighbours = new Neighbours(this.vertexCount, net);
    const bodyNormals = smoothNormals(body, net, neighbours);
    moveInwards(body, bodyNormals, net, held, MOST_INWARDS * spacing);
    const shown = drops.slice(0, MOST_DROPS);
    const positions = new Float32Array(body.length + 3 * DROP.corners.length * shown.length);
    const normals = new Float32Array(positions.length);
    const indices = new Uint32Array(net.length + DROP.faces.length * shown.length);
    positions.set(body);
    normals.set(bodyNormals);
    indices.set(net);
    addDrops(points, spacing, shown, { positions, normals, indices }, this.vertexCount, net.length);
    const thickness = new Float32Array(positions.length / 3).fill(spacing);
    thickness.set(leastAround(this.thicknessOf(body, bodyNormals, spacing), neighbours));
    return { positions, normals, indices, thickness, ...measure(positions, indices) };
  }

  // In each cell with nodes on both sides of the surface: a vertex at the mean of the points where its edges cross it.
  private makeVertices(spacing: number): void {
    const { field } = this;
    if (this.vertexOf.length < field.count * NODES) this.vertexOf = new Int32Array(Math.ceil(1.3 * field.count) * NODES);
    const { vertexOf } = this;
    const corner = [0, 1, WIDE, WIDE + 1, WIDE * WIDE, WIDE * WIDE + 1, WIDE * WIDE + WIDE, WIDE * WIDE + WIDE + 1];
    const inside = new Uint8Array(WIDE ** 3);
    for (let block = 0; block < field.count; ++block) {
      vertexOf.fill(-1, block * NODES, (block + 1) * NODES);
      const values = field.gather(block, field.values, this.padded, 0);
      let filled = 0;
      for (let at = 0; at < inside.length; ++at) filled += inside[at] = values[at]! > LEVEL ? 1 : 0;
      if (filled === 0 || filled === inside.length) continue;
      this.makeRoom(NODES);
      const { vertices } = this;
      const [x0, y0, z0] = field.corner(block);
      for (let node = 0; node < NODES; ++node) {
        const x = node & 7;
        const y = (node >> 3) & 7;
        const z = node >> 6;
        const at = x + 1 + WIDE * (y + 1 + WIDE * (z + 1));
        let sum = 0;
        for (let c = 0; c < 8; ++c) sum += inside[at + corner[c]!]!;
        if (sum === 0 || sum === 8) continue;
        let [sx, sy, sz, count] = [0, 0, 0, 0];
        for (let c = 0; c < 8; ++c) {
          for (let axis = 1; axis < 8; axis <<= 1) {
            const [from, to] = [at + corner[c]!, at + corner[c | axis]!];
            if (inside[from] === inside[to]) continue;
            const first = (values[from]! - LEVEL) / (values[from]! + BEND);
            const share = first / (first - (values[to]! - LEVEL) / (values[to]! + BEND));
            sx += (c & 1) + (axis === 1 ? share : 0);
            sy += ((c >> 1) & 1) + (axis === 2 ? share : 0);
            sz += (c >> 2) + (axis === 4 ? share : 0);
            ++count;
          }
        }
        const vertex = 3 * this.vertexCount;
        vertexOf[block * NODES + node] = this.vertexCount++;
        vertices[vertex] = (x0 + x + sx / count) * spacing;
        vertices[vertex + 1] = (y0 + y + sy / count) * spacing;
        vertices[vertex + 2] = (z0 + z + sz / count) * spacing;
      }
    }
  }

  private makeRoom(more: number): void {
    if (this.vertices.length >= 3 * (this.vertexCount + more)) return;
    const { vertices } = this;
    this.vertices = new Float32Array(2 * (vertices.length + 3 * more));
    this.vertices.set(vertices);
  }

  // Around each edge of the grid that crosses the surface: a quad of the vertices of the four cells around it.
  private makeQuads(): void {
    const { field, vertexOf } = this;
    // The cell at an edge's first node has a vertex, and at most three such edges.
    if (this.indices.length < 18 * this.vertexCount) this.indices = new Uint32Array(24 * this.vertexCount);
    const { indices } = this;
    const step = [1, WIDE, WIDE * WIDE];
    for (let block = 0; block < field.count; ++block) {
      const base = block * NODES;
      let node = 0;
      while (node < NODES && vertexOf[base + node]! < 0) ++node;
      if (node === NODES) continue;
      const values = field.gather(block, field.values, this.padded, 0);
      const cells = field.gather(block, vertexOf, this.paddedVertices, -1);
      for (; node < NODES; ++node) {
        const c = vertexOf[base + node]!;
        if (c < 0) continue;
        const at = (node & 7) + 1 + WIDE * (((node >> 3) & 7) + 1 + WIDE * ((node >> 6) + 1));
        const isInside = values[at]! > LEVEL;
        for (let axis = 0; axis < 3; ++axis) {
          if (isInside === values[at + step[axis]!]! > LEVEL) continue;
          const u = step[(axis + 1) % 3]!;
          const v = step[(axis + 2) % 3]!;
          const [a, b, d] = [cells[at - u - v]!, cells[at - v]!, cells[at - u]!];
          if (a < 0 || b < 0 || d < 0) continue;
          const to = this.indexCount;
          this.indexCount += 6;
          indices[to] = indices[to + 3] = a;
          indices[to + 1] = isInside ? b : c;
          indices[to + 2] = isInside ? c : b;
          indices[to + 4] = isInside ? c : d;
          indices[to + 5] = isInside ? d : c;
        }
      }
    }
  }

  // From each vertex inwards, a grid step at a time, until the liquid ends.
  private thicknessOf(positions: Float32Array, normals: Float32Array, spacing: number): Float32Array {
    const thickness = new Float32Array(positions.length / 3);
    const { field } = this;
    const [x0, y0, z0] = field.lower as [number, number, number];
    for (let vertex = 0; vertex < thickness.length; ++vertex) {
      const at = 3 * vertex;
      const [x, y, z] = [positions[at]! / spacing - x0, positions[at + 1]! / spacing - y0, positions[at + 2]! / spacing - z0];
      let [steps, before, here] = [0, 1, 1];
      while (here > HALF) {
        ++steps;
        before = here;
        here = field.valueAt(Math.round(x - steps * normals[at]!), Math.round(y - steps * normals[at + 1]!), Math.round(z - steps * normals[at + 2]!));
      }
      thickness[vertex] = (steps - (HALF - here) / (before - here)) * spacing;
    }
    return thickness;
  }

  /** Particles around which none of the 27 nodes is inside the surface. */
  private findDrops(points: Float32Array, spacing: number): number[] {
    const { field } = this;
    const { lower } = field;
    const found: number[] = [];
    for (let at = 0; at < points.length; at += 3) {
      const x = Math.round(points[at]! / spacing - lower[0]!);
      const y = Math.round(points[at + 1]! / spacing - lower[1]!);
      const z = Math.round(points[at + 2]! / spacing - lower[2]!);
      // The particle's own node is inside in most cases.
      let isDrop = field.valueAt(x, y, z) <= LEVEL;
      for (let n = 0; isDrop && n < 27; ++n) isDrop = field.valueAt(x + (n % 3) - 1, y + (Math.floor(n / 3) % 3) - 1, z + Math.floor(n / 9) - 1) <= LEVEL;
      if (isDrop) found.push(at);
    }
    return found;
  }
}

/** Writes balls of a particle's volume behind the first `vertices` and `indices` of the arrays. */
function addDrops(points: Float32Array, spacing: number, drops: readonly number[], into: Pick<LiquidMesh, "positions" | "normals" | "indices">, vertices: number, indices: number): void {
  const radius = Math.cbrt(3 / (4 * Math.PI)) * spacing;
  for (const at of drops) {
    for (const face of DROP.faces) into.indices[indices++] = vertices + face;
    for (const corner of DROP.corners) {
      for (let axis = 0; axis < 3; ++axis) {
        into.positions[3 * vertices + axis] = points[at + axis]! + radius * corner[axis]!;
        into.normals[3 * vertices + axis] = corner[axis]!;
      }
      ++vertices;
    }
  }
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
