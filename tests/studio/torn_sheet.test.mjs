// SPDX-License-Identifier: MIT
// The drawn form of a sheet that tears: cut along the tears without a gap, and followed from frame to frame. Lengths are in m.
import assert from "node:assert/strict";
import { createHash } from "node:crypto";
import { describe, it } from "node:test";
import { loadSource, randomNumbers } from "./studio_source.mjs";

const { BoxGeometry, PlaneGeometry, Box3, Matrix4, Quaternion, Vector3, SoftBodies, SoftForm, SoftSkin } = await loadSource(`
  export { BoxGeometry, PlaneGeometry, Box3, Matrix4, Quaternion, Vector3 } from "three";
  export { SoftForm, SoftSkin } from "./view/soft_form";
  export { SoftBodies } from "./view/soft_bodies";
`);

/** Cells along each side of the sheet, of which each is two triangles; the tear is at the line of nodes `TORN`. */
const CELLS = 12;
const TORN = 5;
const RANDOM_SHEETS = 8;

/** A square sheet of 1 m in the plane y = 0 with nodes anywhere near those of a grid, of diagonals of either way. */
function sheet(seed) {
  const random = randomNumbers(seed);
  const nodes = [];
  const triangles = [];
  const inside = (i) => i > 0 && i < CELLS;
  for (let i = 0; i <= CELLS; ++i)
    for (let k = 0; k <= CELLS; ++k)
      nodes.push((i + (inside(i) ? 0.6 * (random() - 0.5) : 0)) / CELLS - 0.5, 0, (k + (inside(k) ? 0.6 * (random() - 0.5) : 0)) / CELLS - 0.5);
  for (let i = 0; i < CELLS; ++i)
    for (let k = 0; k < CELLS; ++k) {
      const [a, b] = [i * (CELLS + 1) + k, (i + 1) * (CELLS + 1) + k];
      triangles.push(...(random() < 0.5 ? [a, a + 1, b, b, a + 1, b + 1] : [a, b + 1, b, a, a + 1, b + 1]));
    }
  return { nodes, triangles };
}

/** The sheet with so many edges torn, from the hem on; the triangles with larger x have the new nodes. */
function tear({ nodes, triangles }, edges) {
  const torn = { nodes: [...nodes], triangles: [...triangles] };
  const copies = new Map();
  for (let k = 0; k < edges + (edges === CELLS ? 1 : 0); ++k) {
    const node = TORN * (CELLS + 1) + k;
    copies.set(node, torn.nodes.length / 3);
    torn.nodes.push(...nodes.slice(3 * node, 3 * node + 3));
  }
  for (let corner = 6 * TORN * CELLS; corner < triangles.length; ++corner) torn.triangles[corner] = copies.get(triangles[corner]) ?? triangles[corner];
  return torn;
}

function isBeyond(mesh, node) {
  return node >= (CELLS + 1) ** 2 || node >= (TORN + 1) * (CELLS + 1);
}

/** The nodes' places where those beyond the tear are moved by `offset(x, y, z)`, the others by its opposite. */
function opened(mesh, offset) {
  const places = Float32Array.from(mesh.nodes);
  for (let node = 0; node < places.length / 3; ++node) {
    const by = offset(...mesh.nodes.slice(3 * node, 3 * node + 3));
    places[3 * node] += isBeyond(mesh, node) ? by : -by;
  }
  return places;
}

function plain(geometry, matrix = new Matrix4()) {
  return { parts: [{ geometry, material: null, matrix }], bounds: new Box3(), castsShadow: true };
}

const flat = () => plain(new PlaneGeometry(1, 1), new Matrix4().makeRotationX(-Math.PI / 2));
const skinOf = (mesh, form = flat()) => new SoftSkin(new SoftForm(mesh, 1), form, "high");

function drawn(skin, places) {
  skin.follow(places);
  const { geometry } = skin.drawable.parts[0];
  return { index: [...geometry.index.array], position: Float32Array.from(geometry.getAttribute("position").array), uv: geometry.getAttribute("uv").array };
}

function area({ index, position }) {
  let sum = 0;
  const [a, b, c] = [new Vector3(), new Vector3(), new Vector3()];
  for (let i = 0; i < index.length; i += 3) {
    [a, b, c].forEach((corner, k) => corner.fromArray(position, 3 * index[i + k]));
    sum += b.sub(a).cross(c.sub(a)).length() / 2;
  }
  return sum;
}

function lengths({ index, position }) {
  return index.map((v, i) => {
    const other = index[i % 3 === 2 ? i - 2 : i + 1];
    return Math.hypot(...[0, 1, 2].map((k) => position[3 * v + k] - position[3 * other + k]));
  });
}

const near = (value, expected, tolerance) => assert.ok(Math.abs(value - expected) < tolerance, `${value} instead of ${expected}`);

describe("the drawn form of a torn sheet", () => {
  it("comes apart along a tear, without a triangle across it and without a gap", () => {
    for (let seed = 1; seed <= RANDOM_SHEETS; ++seed) {
      const mesh = tear(sheet(seed), CELLS);
      const skin = skinOf(mesh);
      const rest = drawn(skin, Float32Array.from(mesh.nodes));
      const apart = drawn(skin, opened(mesh, () => 0.5));
      assert.ok(Math.abs(area(rest) - 1) < 1e-4, `sheet ${seed}: area ${area(rest)} at rest`);
      assert.ok(Math.abs(area(apart) - 1) < 0.01, `sheet ${seed}: area ${area(apart)}`);
      const [before, after] = [lengths(rest), lengths(apart)];
      before.forEach((length, i) => assert.ok(Math.abs(after[i] - length) < 1e-5, `sheet ${seed}: an edge of ${length} became one of ${after[i]}`));
      const moved = rest.position.filter((_, i) => i % 3 === 0).map((x, v) => apart.position[3 * v] - x);
      for (const by of moved) assert.ok(Math.abs(Math.abs(by) - 0.5) < 1e-5, `sheet ${seed}: a vertex moved by ${by}`);
      assert.ok(moved.some((by) => by > 0) && moved.some((by) => by < 0));
    }
  });

  it("is cut at the tear itself, and its texture goes on there", () => {
    for (let seed = 1; seed <= RANDOM_SHEETS; ++seed) {
      const mesh = tear(sheet(seed), CELLS);
      const skin = skinOf(mesh);
      const rest = drawn(skin, Float32Array.from(mesh.nodes));
      const apart = drawn(skin, opened(mesh, () => 0.5));
      // The area on either side is that of the sheet's triangles there.
      const share = (beyond) => area({ ...rest, index: rest.index.filter((_, i) => apart.position[3 * rest.index[i - (i % 3)]] > rest.position[3 * rest.index[i - (i % 3)]] === beyond) });
      const right = mesh.triangles.slice(6 * TORN * CELLS);
      const expected = area({ index: right, position: mesh.nodes });
      assert.ok(Math.abs(share(true) - expected) < 0.002, `sheet ${seed}: ${share(true)} instead of ${expected}`);
      for (let v = 0; v < rest.position.length / 3; ++v) {
        assert.ok(Math.abs(rest.uv[2 * v] - rest.position[3 * v] - 0.5) < 1e-4 && Math.abs(rest.uv[2 * v + 1] + rest.position[3 * v + 2] - 0.5) < 1e-4);
      }
      assert.equal(skin.drawable.parts[0].levels.length, 8);
      for (const level of skin.drawable.parts[0].levels) assert.equal(level, skin.drawable.parts[0].geometry.index);
    }
  });

  it("opens at a slit and is whole beyond its tip", () => {
    for (let seed = 1; seed <= RANDOM_SHEETS; ++seed)
      for (const edges of [1, 2, 6]) {
        const mesh = tear(sheet(seed), edges);
        const tip = mesh.nodes[3 * (TORN * (CELLS + 1) + edges) + 2];
        const skin = skinOf(mesh);
        const rest = drawn(skin, Float32Array.from(mesh.nodes));
        // A shear on each side of it, which keeps the area.
        const slope = 0.3;
        const open = drawn(skin, opened(mesh, (x, y, z) => slope * Math.max(0, tip - z)));
        assert.ok(Math.abs(area(rest) - 1) < 1e-4);
        assert.ok(Math.abs(area(open) - 1) < 0.01, `sheet ${seed}: area ${area(open)}`);
        const [before, after] = [lengths(rest), lengths(open)];
        before.forEach((length, i) => assert.ok(after[i] < 1.2 * length + 0.004, `sheet ${seed}, ${edges} edges: an edge of ${length} became one of ${after[i]}`));
      }
  });

  it("separates all faces of a thick sheet", () => {
    const mesh = tear(sheet(3), CELLS);
    const skin = skinOf(mesh, plain(new BoxGeometry(1, 0.004, 1)));
    const rest = drawn(skin, Float32Array.from(mesh.nodes));
    const apart = drawn(skin, opened(mesh, () => 0.5));
    const [before, after] = [lengths(rest), lengths(apart)];
    before.forEach((length, i) => assert.ok(Math.abs(after[i] - length) < 1e-5));
    assert.ok(Math.abs(area(apart) - 2.016) < 0.001, `${area(apart)}`);
  });

  it("is the same whether the sheet was drawn before or not", () => {
    const mesh = sheet(2);
    let skin = skinOf(mesh);
    for (const next of [tear(mesh, 3), tear(mesh, CELLS), mesh]) {
      skin.follow(opened(next, (x, y, z) => 0.1 + 0.1 * z));
      skin = new SoftSkin(new SoftForm(next, 1), flat(), "high", skin);
      const places = opened(next, (x, y, z) => 0.1 * z);
      assert.deepEqual(drawn(skin, places), drawn(skinOf(next), places));
    }
    // Not what another form was.
    const small = plain(new PlaneGeometry(0.5, 1), new Matrix4().makeRotationX(-Math.PI / 2));
    near(area(drawn(new SoftSkin(new SoftForm(mesh, 1), small, "high", skin), Float32Array.from(mesh.nodes))), 0.5, 1e-6);
  });

  it("is as ever where nothing is torn", () => {
    const mesh = sheet(1);
    const skin = skinOf(mesh);
    skin.follow(Float32Array.from(mesh.nodes, (number, i) => number + 0.05 * Math.fround(Math.sqrt((i * 7919) % 101) / 10)));
    const { geometry } = skin.drawable.parts[0];
    const hash = createHash("sha256");
    // The bits of the time when no sheet could tear.
    for (const array of [geometry.index.array, geometry.getAttribute("position").array, geometry.getAttribute("normal").array, geometry.getAttribute("uv").array]) hash.update(Float32Array.from(array));
    for (const level of skin.drawable.parts[0].levels) hash.update(Float32Array.from(level.array));
    assert.equal(hash.digest("hex").slice(0, 16), "160d9996897e252e");
  });
});

/** Softs of a page whose server answers each question after a while, and one entity with a sheet among them. */
class Page {
  asked = [];
  /** How many points each question was about. */
  points = [];
  softs = new SoftBodies({
    request: (command, { points }) => {
      this.points.push(points);
      return new Promise((answer) => this.asked.push((mesh) => answer({ mesh })));
    },
  });
  time = 0;

  /** A frame with these places; returns whether another skin is wanted. */
  take(places) {
    const positions = Uint16Array.from(places, (number) => Math.round((65535 * (number + 2)) / 4));
    const set = { index: 2, lower: [-2, -2, -2], size: [4, 4, 4], radius: 0, liquid: false, positions };
    return this.softs.take({ indices: [2], pointed: [1], sets: [set] }, (this.time += 16), false).includes(2);
  }

  dress() {
    return this.softs.dress(2, flat(), 1, "high");
  }

  async answer(mesh, dressing) {
    await new Promise((done) => setTimeout(done));
    this.asked.shift()(mesh);
    return dressing;
  }

  /** The drawn form's area, and its extent along x. */
  drawn() {
    this.softs.bend(2, this.time, new Vector3(), new Quaternion(), 1);
    const { geometry } = this.softs.skinOf(2).drawable.parts[0];
    const { min, max } = geometry.boundingBox;
    return { area: area({ index: [...geometry.index.array], position: geometry.getAttribute("position").array }), width: max.x - min.x };
  }
}

const whole = sheet(1);
const torn = tear(whole, CELLS);
const halfTorn = tear(whole, 6);
const added = (mesh) => (mesh.nodes.length - whole.nodes.length) / 3;

async function pageWith(mesh) {
  const page = new Page();
  assert.ok(page.take(mesh.nodes));
  await page.answer(mesh, page.dress());
  return page;
}

describe("a sheet that tears from frame to frame", () => {
  it("keeps its form until the torn one is there, and asks once for it", async () => {
    const page = await pageWith(whole);
    const skin = page.softs.skinOf(2);
    page.softs.tear(2, added(torn));
    assert.ok(page.take(opened(torn, () => 0.01)));
    const dressing = page.dress();
    assert.ok(!page.take(opened(torn, () => 0.02)), "it was asked for");
    assert.equal(page.softs.skinOf(2), skin);
    near(page.drawn().width, 1.04, 1e-3);
    const next = await page.answer(torn, dressing);
    assert.ok(next && next !== skin && page.softs.skinOf(2) === next);
    near(page.drawn().area, 1, 1e-3);
    assert.ok(!page.take(opened(torn, () => 0.03)), "nothing is asked for while nothing tears");
  });

  it("takes a mesh that is newer than the frame, and asks again with the next one", async () => {
    const page = await pageWith(whole);
    page.softs.tear(2, added(halfTorn));
    assert.ok(page.take(opened(halfTorn, () => 0)));
    assert.ok(await page.answer(torn, page.dress()));
    near(page.drawn().area, 1, 1e-3);
    assert.ok(page.take(opened(torn, () => 0.25)));
    assert.ok(await page.answer(torn, page.dress()));
    near(page.drawn().area, 1, 0.01);
    near(page.drawn().width, 1.5, 1e-3);
    assert.ok(!page.take(opened(torn, () => 0.3)));
  });

  it("does not stay undressed where the first mesh is another one", async () => {
    const page = new Page();
    assert.ok(page.take(torn.nodes));
    assert.equal(await page.answer(whole, page.dress()), null);
    assert.ok(page.take(torn.nodes));
    assert.ok(await page.answer(torn, page.dress()));
  });

  it("is less torn back in time at once, and whole after a reset", async () => {
    const page = await pageWith(torn);
    page.take(opened(torn, () => 0.25));
    near(page.drawn().width, 1.5, 1e-3);
    assert.ok(page.take(whole.nodes), "the whole mesh is asked for");
    near(page.drawn().width, 1, 1e-3);
    near(page.drawn().area, 1, 1e-3);
    const skin = await page.answer(whole, page.dress());
    assert.equal(skin.form.origins, null);
    near(page.drawn().area, 1, 1e-3);
  });

  it("asks for the mesh of the frame that is drawn, as films of a take need it", async () => {
    const page = await pageWith(torn);
    for (const mesh of [halfTorn, whole, torn]) {
      page.take(mesh.nodes);
      assert.ok(await page.answer(mesh, page.dress()));
      assert.equal(page.points.at(-1), mesh.nodes.length / 3);
    }
  });

  it("does not bend with the nodes of a sheet that was meshed anew", async () => {
    const page = await pageWith(whole);
    assert.ok(page.take([...whole.nodes, 0, 0, 0]));
    assert.equal(page.softs.skinOf(2), null);
  });
});
