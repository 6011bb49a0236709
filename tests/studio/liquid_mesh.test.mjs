// SPDX-License-Identifier: MIT
// The surface of a liquid that the Studio makes from particles: closed, smooth, as large as they are, at every moment. Lengths are in spacings.
import assert from "node:assert/strict";
import { describe, it } from "node:test";
import { loadSource, randomNumbers } from "./studio_source.mjs";

const { LiquidMesher } = await loadSource(`export * from "${process.env.EMBODY_TEST_MESHER ?? "./view/liquid_mesher.ts"}"`);

/** Particles of a box: each somewhere in its cube of the volume (`jitter` 1) or in the middle of it (0). */
function box(size, jitter, random) {
  const points = [];
  for (let x = 0; x < size[0]; ++x)
    for (let y = 0; y < size[1]; ++y)
      for (let z = 0; z < size[2]; ++z) points.push([x, y, z].map((at) => at + 0.5 + jitter * (random() - 0.5)));
  return points;
}

/** Spread to `factor` times their area, and as much thinner: gaps open along x and z, as in honey that runs apart. */
function spread(points, factor) {
  const side = Math.sqrt(factor);
  return points.map(([x, y, z]) => [x * side, y / factor, z * side]);
}

/** Drawn to the faces of cells two spacings wide: particles of a liquid on a grid gather there. */
function gather(points, share) {
  const along = (x) => x + (share * Math.sin(Math.PI * x)) / Math.PI;
  return points.map(([x, y, z]) => [along(x), y, along(z)]);
}

function meshOf(points, shift = [0, 0, 0]) {
  const mesh = new LiquidMesher().build(new Float32Array(points.flatMap((point) => point.map((x, axis) => x + shift[axis]))), 1);
  for (let at = 0; at < mesh.positions.length; ++at) mesh.positions[at] -= shift[at % 3];
  return mesh;
}

/** Number of connected parts, of edges that have no opposite, and of handles and holes of all parts. */
function topology({ indices }) {
  const above = new Map();
  const find = (vertex) => {
    while (above.get(vertex) !== vertex) vertex = above.get(vertex);
    return vertex;
  };
  const edges = new Set();
  const key = (a, b) => a * 1e7 + b;
  for (const vertex of indices) above.set(vertex, vertex);
  for (let at = 0; at < indices.length; at += 3)
    for (let k = 0; k < 3; ++k) {
      const [a, b] = [indices[at + k], indices[at + ((k + 1) % 3)]];
      edges.add(key(a, b));
      const [one, other] = [find(a), find(b)];
      if (one !== other) above.set(one, other);
    }
  const open = [...edges].filter((edge) => !edges.has(key(edge % 1e7, Math.floor(edge / 1e7)))).length;
  const parts = [...above.keys()].filter((vertex) => above.get(vertex) === vertex).length;
  const euler = above.size - edges.size / 2 + indices.length / 3;
  return { parts, open, handles: parts - euler / 2 };
}

/** Height of the uppermost surface over a point, or null. */
function heightOver({ positions, indices }, x, z) {
  let height = null;
  for (let at = 0; at < indices.length; at += 3) {
    const [a, b, c] = [0, 1, 2].map((k) => positions.subarray(3 * indices[at + k], 3 * indices[at + k] + 3));
    const cross = (p, q) => (q[0] - p[0]) * (z - p[2]) - (q[2] - p[2]) * (x - p[0]);
    const [u, v, w] = [cross(b, c), cross(c, a), cross(a, b)];
    // Triangles that face up turn clockwise in x and z.
    if (u > 0 || v > 0 || w > 0 || u + v + w === 0) continue;
    const y = (u * a[1] + v * b[1] + w * c[1]) / (u + v + w);
    if (height === null || y > height) height = y;
  }
  return height;
}

/** Upside down. */
function mirrored({ positions, indices }) {
  return { positions: positions.map((x, at) => (at % 3 === 1 ? -x : x)), indices: indices.map((_, at) => indices[3 * Math.floor(at / 3) + 2 - (at % 3)]) };
}

function deviation(values) {
  const mean = values.reduce((sum, value) => sum + value, 0) / values.length;
  return Math.sqrt(values.reduce((sum, value) => sum + (value - mean) ** 2, 0) / values.length);
}

/** Heights of the vertices on top of a pool and their normals' slopes, away from its edges. */
function top({ positions, normals }, size, height) {
  const heights = [];
  let slopes = 0;
  for (let at = 0; at < positions.length; at += 3) {
    const [x, y, z] = positions.subarray(at, at + 3);
    if (Math.min(x, z, size[0] - x, size[2] - z) < 4 || y < height / 2) continue;
    heights.push(y);
    slopes += normals[at] ** 2 + normals[at + 2] ** 2;
  }
  return { heights, slope: Math.sqrt(slopes / heights.length) };
}

const FAMILY = Array.from({ length: 12 }, (_, seed) => {
  const random = randomNumbers(seed + 1);
  const between = (least, most) => least + (most - least) * random();
  return { random, between, shift: [between(-3, 3), between(-3, 3), between(-3, 3)] };
});
const SHOWS = process.env.EMBODY_TEST_FIGURES ? console.log : () => {};

describe("the surface of a liquid", () => {
  it("of a pool at rest is flat and closed, and has the particles' volume", () => {
    for (const { random, between, shift } of FAMILY) {
      const size = [between(20, 30), between(2, 9), between(20, 30)].map(Math.round);
      const mesh = meshOf(box(size, between(0.3, 0.8), random), shift);
      const { heights, slope } = top(mesh, size, size[1]);
      const volume = mesh.volume / (size[0] * size[1] * size[2]);
      SHOWS("pool", size, "unevenness", deviation(heights).toFixed(3), "slope", slope.toFixed(3), "volume", volume.toFixed(3));
      assert.deepEqual(topology(mesh), { parts: 1, open: 0, handles: 0 });
      assert.ok(Math.abs(volume - 1) < 0.01, `volume ${volume}`);
      assert.ok(deviation(heights) < 0.06, `uneven by ${deviation(heights)}`);
      assert.ok(slope < 0.03, `slopes of ${slope}`);
    }
  });

  it("of honey that has run apart has neither pinholes nor wrinkles", () => {
    for (const { random, between, shift } of FAMILY) {
      const factor = between(1.5, 2.2);
      const layers = Math.round(between(4, 8));
      const points = spread(gather(box([20, layers, 20], between(0.4, 0.9), random), between(0.5, 0.8)), factor);
      const mesh = meshOf(points, shift);
      const side = 20 * Math.sqrt(factor);
      const { heights, slope } = top(mesh, [side, 0, side], layers / factor);
      SHOWS("honey", factor.toFixed(2), layers, topology(mesh), "unevenness", deviation(heights).toFixed(3), "slope", slope.toFixed(3), "volume", (mesh.volume / points.length).toFixed(3));
      assert.deepEqual(topology(mesh), { parts: 1, open: 0, handles: 0 });
      assert.ok(deviation(heights) < 0.06, `uneven by ${deviation(heights)}`);
      assert.ok(slope < 0.03, `slopes of ${slope}`);
    }
  });

  it("of a film of two layers has no pinholes, and of one layer is not inside out", () => {
    for (const { random, between, shift } of FAMILY) {
      const two = meshOf(spread(box([24, 2, 24], between(0.5, 1), random), between(1, 1.4)), shift);
      const one = meshOf(box([24, 1, 24], between(0.2, 0.6), random), shift);
      SHOWS("film", topology(two), topology(one), "volume of one layer", (one.volume / 576).toFixed(3));
      for (const film of [two, one]) assert.deepEqual(topology(film), { parts: 1, open: 0, handles: 0 });
      const upper = Array.from({ length: 40 }, () => heightOver(one, between(3, 21), between(3, 21)));
      assert.ok(upper.every((height) => height > 0.5), `the upper side is at ${Math.min(...upper)}`);
      assert.ok(Math.abs(one.volume / 576 - 1) < 0.02, `volume ${one.volume / 576}`);
    }
  });

  it("of a jet two spacings thick is one piece", () => {
    for (const { random, between, shift } of FAMILY) {
      const stretch = between(1, 1.5);
      const jet = box([2, 24, 2], between(0.4, 1), random).map(([x, y, z]) => [x / Math.sqrt(stretch), y * stretch, z / Math.sqrt(stretch)]);
      const mesh = meshOf(jet, shift);
      SHOWS("jet", stretch.toFixed(2), topology(mesh), "volume", (mesh.volume / 96).toFixed(3));
      assert.deepEqual(topology(mesh), { parts: 1, open: 0, handles: 0 });
      assert.ok(Math.abs(mesh.volume / 96 - 1) < 0.04, `volume ${mesh.volume / 96}`);
    }
  });

  it("of films and jets is not inside out beside a deep pool", () => {
    for (const { random, between, shift } of FAMILY) {
      const pool = box([16, 16, 16], 0.8, random);
      const film = box([16, 1, 16], between(0.2, 0.6), random).map(([x, y, z]) => [x + 24, y, z]);
      const mesh = meshOf([...pool, ...film], shift);
      const upper = Array.from({ length: 20 }, () => heightOver(mesh, between(27, 37), between(3, 13)));
      const lower = Array.from({ length: 20 }, () => -heightOver(mirrored(mesh), between(27, 37), between(3, 13)));
      SHOWS("beside", topology(mesh), "film from", Math.max(...lower).toFixed(2), "to", Math.min(...upper).toFixed(2));
      assert.deepEqual(topology(mesh), { parts: 2, open: 0, handles: 0 });
      // Clusters of a few particles.
      const clusters = [2, 3, 4, 6].flatMap((count, at) => Array.from({ length: count }, () => [24 + 6 * at + 1.2 * random(), 12 + 1.2 * random(), 1.2 * random()]));
      const held = meshOf([...pool, ...clusters], shift).volume - meshOf(pool, shift).volume;
      SHOWS("beside clusters", held.toFixed(2));
      assert.ok(held > 4 && held < 25, `fifteen particles' volume is ${held}`);
      assert.ok(Math.min(...upper) - Math.max(...lower) > 0.6, `the film is ${Math.min(...upper) - Math.max(...lower)} thick`);
    }
  });

  it("stays outside of particles that are too far apart for their volume", () => {
    for (const { random, between, shift } of FAMILY) {
      const apart = between(1.2, 1.3);
      const points = box([14, 14, 14], 0.3, random).map((point) => point.map((x) => apart * x));
      const mesh = meshOf(points, shift);
      const { heights } = top(mesh, [14 * apart, 0, 14 * apart], 14 * apart);
      const depth = Math.max(...points.map(([, y]) => y)) - heights.reduce((sum, height) => sum + height, 0) / heights.length;
      SHOWS("apart", apart.toFixed(2), "depth", depth.toFixed(2));
      assert.ok(depth < 0.5, `${depth} below the uppermost particle`);
    }
  });

  it("moves along with its particles, wherever they are in the grid", () => {
    for (const { random, between, shift } of FAMILY) {
      const points = box([16, 4, 16], between(0.3, 0.8), random);
      const [one, other] = [meshOf(points), meshOf(points, shift)];
      const differences = [];
      for (let probe = 0; probe < 60; ++probe) {
        const [x, z] = [between(3, 13), between(3, 13)];
        differences.push(heightOver(other, x, z) - heightOver(one, x, z));
      }
      const change = Math.sqrt(differences.reduce((sum, value) => sum + value ** 2, 0) / differences.length);
      SHOWS("flicker", change.toFixed(3));
      assert.ok(change < 0.03, `the grid shows by ${change}`);
    }
  });

  it("knows how thick the liquid is, at the rim of a film, too", () => {
    for (const { random, between, shift } of FAMILY) {
      const layers = Math.round(between(3, 5));
      const mesh = meshOf(box([24, layers, 24], between(0.3, 0.8), random), shift);
      let [sum, count] = [0, 0];
      mesh.thickness.forEach((thickness, vertex) => {
        const [x, y, z] = mesh.positions.subarray(3 * vertex, 3 * vertex + 3);
        assert.ok(thickness > 0 && thickness < 2 * layers, `${thickness} of ${layers} at ${[x, y, z]}`);
        if (Math.min(x, z, 24 - x, 24 - z) < 6) return;
        sum += thickness;
        ++count;
      });
      SHOWS("thickness", (sum / count).toFixed(2), "of", layers);
      assert.ok(Math.abs(sum / count - layers) < 0.6, `${sum / count} of ${layers}`);
    }
  });

  it("keeps single drops as balls of their volume", () => {
    for (const { between } of FAMILY) {
      const drops = Array.from({ length: 5 }, (_, at) => [5 * at + between(0, 1), between(0, 1), between(0, 1)]);
      const mesh = meshOf(drops);
      assert.equal(topology(mesh).parts, 5);
      // An octahedron with its faces divided has 0.68 of its ball's volume.
      assert.ok(mesh.volume > 3 && mesh.volume < 5, `volume ${mesh.volume}`);
    }
  });
});
