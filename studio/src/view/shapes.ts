// SPDX-License-Identifier: MIT
import {
  BufferAttribute,
  BufferGeometry,
  Matrix4,
  MeshStandardMaterial,
  PlaneGeometry,
  Quaternion,
  Vector3,
} from "three";
import { ConvexGeometry } from "three/examples/jsm/geometries/ConvexGeometry.js";
import { toCreasedNormals } from "three/examples/jsm/utils/BufferGeometryUtils.js";
import { positionOf, rotationOf } from "../document/scene_document";
import type { Shape, WallShape } from "../connection/scene_types";
import { frameGeometry, paneGeometry, slabGeometry, wallGeometry } from "./building_shapes";
import { type Drawable, type DrawablePart, drawable } from "./drawable";
import { drawingOf, isOfLengths } from "./shapes_of_lengths";

/** Half the side of the square that is drawn for an infinite plane, m. */
const PLANE_REACH = 500;
/** Faces of a hull that meet at a smaller angle are drawn as one round surface, rad. */
const CREASE = 0.75;
const UP = new Vector3(0, 1, 0);
const ONE = new Vector3(1, 1, 1);

/** The colour is an attribute of each instance, so that all primitives share materials. */
function material(): MeshStandardMaterial {
  return new MeshStandardMaterial({ color: 0xffffff, roughness: 0.75, metalness: 0 });
}

function part(geometry: BufferGeometry, matrix = new Matrix4()): DrawablePart {
  return { geometry, material: material(), matrix };
}

/** A drawable for any shape of the scene format. Throws where the shape has no surface, such as a hull of three points. */
export function drawShape(shape: Shape): Drawable {
  const parts = shapeParts(shape);
  return drawable(parts, shape.type !== "plane");
}

/** Entities whose shapes have the same key look alike. */
export function shapeKey(shape: Shape): string {
  return JSON.stringify(shape);
}

function shapeParts(shape: Shape): DrawablePart[] {
  if (isOfLengths(shape)) {
    const { geometry, size } = drawingOf(shape);
    return [part(geometry, new Matrix4().makeScale(...size))];
  }
  switch (shape.type) {
    case "hull":
      return [part(toCreasedNormals(new ConvexGeometry(shape.points.map((point) => new Vector3(...point))), CREASE))];
    case "plane":
      return [planePart(shape.normal ?? [0, 1, 0], shape.offset ?? 0)];
    case "heightfield":
      return [part(heightfieldGeometry(shape))];
    case "mesh":
      return [part(meshGeometry(shape))];
    case "wall":
      return wallParts(shape);
    case "slab":
      return [part(slabGeometry(shape))];
    case "compound":
      return shape.children.flatMap((child) => {
        const local = new Matrix4().compose(
          new Vector3(...positionOf(child)),
          new Quaternion(...rotationOf(child)),
          ONE,
        );
        return shapeParts(child).map((each) => ({ ...each, matrix: local.clone().multiply(each.matrix) }));
      });
  }
}

function wallParts(shape: WallShape): DrawablePart[] {
  const parts = [part(wallGeometry(shape))];
  const frames = frameGeometry(shape);
  if (frames) parts.push({ ...part(frames), material: new MeshStandardMaterial({ color: 0xffffff, roughness: 0.45 }) });
  const panes = paneGeometry(shape);
  if (panes) parts.push({ ...part(panes), material: new MeshStandardMaterial({ color: 0xbfd8e6, roughness: 0.05, transparent: true, opacity: 0.28 }) });
  return parts;
}

function planePart(normal: readonly number[], offset: number): DrawablePart {
  const up = new Vector3().fromArray(normal).normalize();
  const matrix = new Matrix4().compose(up.clone().multiplyScalar(offset), new Quaternion().setFromUnitVectors(UP, up), ONE);
  const geometry = new PlaneGeometry(2 * PLANE_REACH, 2 * PLANE_REACH);
  geometry.rotateX(-Math.PI / 2);
  return part(geometry, matrix);
}

function heightfieldGeometry(shape: Extract<Shape, { type: "heightfield" }>): BufferGeometry {
  const { columns, rows, heights } = shape;
  const positions = new Float32Array(columns * rows * 3);
  for (let row = 0, at = 0; row < rows; ++row)
    for (let column = 0; column < columns; ++column, at += 3) {
      positions[at] = column * (shape.cell_x ?? 1);
      positions[at + 1] = heights[row * columns + column] ?? 0;
      positions[at + 2] = row * (shape.cell_z ?? 1);
    }

  // Each cell is split along the diagonal from (c, r) to (c+1, r+1), as the physics does.
  const triangles = new Uint32Array((columns - 1) * (rows - 1) * 6);
  for (let row = 0, at = 0; row + 1 < rows; ++row)
    for (let column = 0; column + 1 < columns; ++column, at += 6) {
      const corner = row * columns + column;
      triangles.set([corner, corner + columns, corner + columns + 1, corner, corner + columns + 1, corner + 1], at);
    }
  return indexed(positions, triangles);
}

function meshGeometry(shape: Extract<Shape, { type: "mesh" }>): BufferGeometry {
  const geometry = indexed(new Float32Array(shape.positions.flat()), new Uint32Array(shape.triangles.flat()));
  // Flat shading shows the triangles that the physics uses.
  const flat = geometry.toNonIndexed();
  flat.computeVertexNormals();
  return flat;
}

function indexed(positions: Float32Array, triangles: Uint32Array): BufferGeometry {
  const geometry = new BufferGeometry();
  geometry.setAttribute("position", new BufferAttribute(positions, 3));
  geometry.setIndex(new BufferAttribute(triangles, 1));
  geometry.computeVertexNormals();
  return geometry;
}
