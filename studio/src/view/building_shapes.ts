// SPDX-License-Identifier: MIT
import { BufferAttribute, BufferGeometry, ShapeUtils, Vector2, Vector3 } from "three";
import type { SlabShape, WallOpening, WallShape } from "../connection/scene_types";

/** As in the core (building_shapes.h): a window's glass, m. */
const PANE_THICKNESS = 0.02;
/** Breadth and depth of the frames that are drawn in doors and windows, m. */
const FRAME_BREADTH = 0.04;
const FRAME_DEPTH = 0.03;

type Place = readonly [number, number, number];

/** Triangles with flat faces, collected. */
class Faces {
  private readonly positions: number[] = [];

  /** A flat convex face, seen from the side that `outward` points to. */
  add(corners: readonly Place[], outward: Place): void {
    // The sum over all corners: some may lie in one place.
    const area = new Vector3();
    const [from, to] = [new Vector3(), new Vector3()];
    corners.forEach((corner, k) => area.add(from.fromArray(corner).cross(to.fromArray(corners[(k + 1) % corners.length]!))));
    const turned = area.dot(to.fromArray(outward)) < 0;
    for (let k = 1; k + 1 < corners.length; ++k) {
      const triangle = turned ? [corners[0]!, corners[k + 1]!, corners[k]!] : [corners[0]!, corners[k]!, corners[k + 1]!];
      for (const corner of triangle) this.positions.push(...corner);
    }
  }

  addBox(low: Place, high: Place): void {
    for (let axis = 0; axis < 3; ++axis)
      for (const side of [0, 1]) {
        const [u, v] = [(axis + 1) % 3, (axis + 2) % 3] as const;
        const at = [0, 1, 2, 3].map((k) => {
          const corner = [0, 0, 0] as [number, number, number];
          corner[axis] = (side ? high : low)[axis]!;
          corner[u] = (k === 1 || k === 2 ? high : low)[u]!;
          corner[v] = (k > 1 ? high : low)[v]!;
          return corner;
        });
        const outward = [0, 0, 0] as [number, number, number];
        outward[axis] = side ? 1 : -1;
        this.add(at, outward);
      }
  }

  get isEmpty(): boolean {
    return this.positions.length === 0;
  }

  build(): BufferGeometry {
    const geometry = new BufferGeometry();
    geometry.setAttribute("position", new BufferAttribute(new Float32Array(this.positions), 3));
    geometry.computeVertexNormals();
    return geometry;
  }
}

export function heightAt(wall: WallShape, x: number): number {
  return Math.max(0, wall.height + ((wall.rise ?? 0) * x) / wall.length);
}

/** What of an opening lies in the wall's straight part, where the core cuts it. */
function cutOf(wall: WallShape, opening: WallOpening): { from: number; to: number; lower: number; upper: number } {
  const first = Math.max(...(wall.start_cut ?? [0]), 0);
  const last = wall.length - Math.max(...(wall.end_cut ?? [0]), 0);
  const within = (x: number) => Math.min(Math.max(x, first), last);
  const lower = opening.sill ?? 0;
  return { from: within(opening.offset), to: within(opening.offset + opening.width), lower, upper: lower + opening.height };
}

/**
 * The wall as a lattice between all edges of its openings: what is solid has faces in front and behind, and a face wherever it ends.
 * So no face lies inside the wall and no edge meets the middle of another.
 */
export function wallGeometry(wall: WallShape): BufferGeometry {
  const half = wall.thickness / 2;
  const cuts = (wall.openings ?? []).map((opening) => cutOf(wall, opening)).filter(({ from, to }) => to > from);
  const rise = wall.rise ?? 0;
  const inner = cuts.flatMap(({ from, to, lower, upper }) => {
    const crossings = rise === 0 ? [] : [lower, upper].map((y) => ((y - wall.height) / rise) * wall.length).filter((x) => x > from && x < to);
    return [from, to, ...crossings];
  });
  const xs = [Number.NEGATIVE_INFINITY, ...unique(inner), Number.POSITIVE_INFINITY];
  const highest = Math.max(wall.height, wall.height + rise);
  const ys = unique([0, highest, ...cuts.flatMap(({ lower, upper }) => [lower, upper]).filter((y) => y > 0 && y < highest)]);
  const last = xs.length - 1;
  const ends = { start: wall.start_cut ?? [0, 0], end: wall.end_cut ?? [0, 0] };
  /** The vertex on a face: 0 behind, 1 in front. */
  const vertex = (i: number, j: number, side: 0 | 1): Place => {
    const x = i === 0 ? ends.start[side] : i === last ? wall.length - ends.end[side] : xs[i]!;
    return [x, j === ys.length - 1 ? heightAt(wall, x) : Math.min(ys[j]!, heightAt(wall, x)), side ? half : -half];
  };
  const middleOf = (i: number): number => {
    const from = i === 0 ? 0 : xs[i]!;
    return (from + (i + 1 === last ? wall.length : xs[i + 1]!)) / 2;
  };
  const isSolid = (i: number, j: number): boolean => {
    if (i < 0 || j < 0 || i >= last || j >= ys.length - 1) return false;
    const x = middleOf(i);
    const top = heightAt(wall, x);
    const y = (Math.min(ys[j]!, top) + (j === ys.length - 2 ? top : Math.min(ys[j + 1]!, top))) / 2;
    if (ys[j]! >= top) return false;
    return !cuts.some(({ from, to, lower, upper }) => from < x && x < to && lower < y && y < upper);
  };
  const tips = {
    start: ends.start[0] + ends.start[1] > 1e-4 ? 0 : null,
    end: ends.end[0] + ends.end[1] > 1e-4 ? wall.length : null,
  };

  const faces = new Faces();
  for (let i = 0; i <= last; ++i)
    for (let j = 0; j < ys.length; ++j) {
      const solid = isSolid(i, j);
      if (solid)
        for (const side of [0, 1] as const)
          faces.add([vertex(i, j, side), vertex(i + 1, j, side), vertex(i + 1, j + 1, side), vertex(i, j + 1, side)], [0, 0, side ? 1 : -1]);
      // Where the wall begins or ends along its length.
      if (solid !== isSolid(i - 1, j)) {
        const outward: Place = [solid ? -1 : 1, 0, 0];
        const tip = i === 0 ? tips.start : i === last ? tips.end : null;
        const low = [vertex(i, j, 0), ...(tip === null ? [] : [[tip, vertex(i, j, 0)[1], 0] as Place]), vertex(i, j, 1)];
        const high = [vertex(i, j + 1, 0), ...(tip === null ? [] : [[tip, j + 2 === ys.length ? heightAt(wall, tip) : ys[j + 1]!, 0] as Place]), vertex(i, j + 1, 1)];
        for (let k = 0; k + 1 < low.length; ++k) faces.add([low[k]!, low[k + 1]!, high[k + 1]!, high[k]!], outward);
      }
      // Where it begins or ends in height.
      if (solid !== isSolid(i, j - 1)) {
        const corners: Place[] = [vertex(i, j, 0), vertex(i + 1, j, 0)];
        if (i + 1 === last && tips.end !== null) corners.push([tips.end, vertex(last, j, 0)[1], 0]);
        corners.push(vertex(i + 1, j, 1), vertex(i, j, 1));
        if (i === 0 && tips.start !== null) corners.push([tips.start, vertex(0, j, 0)[1], 0]);
        faces.add(corners, [0, solid ? -1 : 1, 0]);
      }
    }
  return faces.build();
}

/** The glass of all windows without a model; null where there are none. */
export function paneGeometry(wall: WallShape): BufferGeometry | null {
  const faces = new Faces();
  const half = Math.min(PANE_THICKNESS, wall.thickness / 2) / 2;
  for (const opening of wall.openings ?? []) {
    if (opening.kind !== "window") continue;
    const { from, to, lower, upper } = cutOf(wall, opening);
    const top = Math.min(upper, heightAt(wall, from), heightAt(wall, to));
    if (to > from && top > lower) faces.addBox([from, lower, -half], [to, top, half]);
  }
  return faces.isEmpty ? null : faces.build();
}

/** Frames of doors and windows without a model; null where there are none. */
export function frameGeometry(wall: WallShape): BufferGeometry | null {
  const faces = new Faces();
  const depth = wall.thickness / 2 + FRAME_DEPTH / 2;
  for (const opening of wall.openings ?? []) {
    if (opening.kind === "hole") continue;
    const { from, to, lower, upper } = cutOf(wall, opening);
    if (to - from < 4 * FRAME_BREADTH || upper - lower < 4 * FRAME_BREADTH) continue;
    const [a, b] = [from + FRAME_BREADTH, to - FRAME_BREADTH];
    const top = upper - FRAME_BREADTH;
    const bottom = opening.kind === "window" ? lower + FRAME_BREADTH : lower;
    faces.addBox([from, lower, -depth], [a, upper, depth]);
    faces.addBox([b, lower, -depth], [to, upper, depth]);
    faces.addBox([a, top, -depth], [b, upper, depth]);
    if (opening.kind === "window") {
      faces.addBox([a, lower, -depth], [b, bottom, depth]);
      const middle = (a + b) / 2;
      if (b - a > 0.7) faces.addBox([middle - FRAME_BREADTH / 2, bottom, -FRAME_DEPTH], [middle + FRAME_BREADTH / 2, top, FRAME_DEPTH]);
    }
  }
  return faces.isEmpty ? null : faces.build();
}

export function slabGeometry(slab: SlabShape): BufferGeometry {
  const faces = new Faces();
  const outline = slab.points.map(([x, z]) => new Vector2(x, z));
  const isPositive = !ShapeUtils.isClockWise(outline);
  for (const triangle of ShapeUtils.triangulateShape(outline, []))
    for (const [y, up] of [[0, 1], [-slab.thickness, -1]] as const)
      faces.add(triangle.map((k) => [outline[k]!.x, y, outline[k]!.y] as Place), [0, up, 0]);
  outline.forEach((a, k) => {
    const b = outline[(k + 1) % outline.length]!;
    const outward: Place = isPositive ? [b.y - a.y, 0, a.x - b.x] : [a.y - b.y, 0, b.x - a.x];
    faces.add([[a.x, 0, a.y], [b.x, 0, b.y], [b.x, -slab.thickness, b.y], [a.x, -slab.thickness, a.y]], outward);
  });
  return faces.build();
}

function unique(values: readonly number[]): number[] {
  return [...new Set(values)].sort((a, b) => a - b);
}
