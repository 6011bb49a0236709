// SPDX-License-Identifier: MIT
import { type BufferAttribute, type BufferGeometry, Vector3 } from "three";

/** A level with less than this part of the surface has lost what it should show. */
const LEAST_AREA = 0.6;

const [a, b, c] = [new Vector3(), new Vector3(), new Vector3()];

/** The area of triangles, in the geometry's own units. */
function areaOf(geometry: BufferGeometry, index: BufferAttribute | null): number {
  const position = geometry.getAttribute("position");
  const count = index?.count ?? position.count;
  let area = 0;
  for (let at = 0; at + 2 < count; at += 3) {
    a.fromBufferAttribute(position, index?.getX(at) ?? at);
    b.fromBufferAttribute(position, index?.getX(at + 1) ?? at + 1).sub(a);
    c.fromBufferAttribute(position, index?.getX(at + 2) ?? at + 2).sub(a);
    area += b.cross(c).length() / 2;
  }
  return area;
}

/**
 * The levels of detail of a part, each that has lost its surface replaced by the one before. Two layers of a thin sheet, such as a leaf or a
 * lampshade, shrink within their own plane at no distance from it, so that a level's error does not tell that they have gone. Only what is smaller than
 * the error, m, may go; `scale` is the geometry's unit in metres.
 */
export function wholeLevels(geometry: BufferGeometry, levels: readonly (BufferAttribute | null)[], errors: readonly number[], scale: number): (BufferAttribute | null)[] {
  if (!geometry.boundingBox) geometry.computeBoundingBox();
  const size = scale * geometry.boundingBox!.getSize(new Vector3()).length();
  const least = LEAST_AREA * areaOf(geometry, geometry.index);
  let whole = geometry.index;
  return levels.map((level, at) => {
    if (size < errors[at]!) return level;
    if (level && areaOf(geometry, level) >= least) whole = level;
    return whole;
  });
}
