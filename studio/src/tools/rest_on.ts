// SPDX-License-Identifier: MIT
import { type Box3, Vector3 } from "three";

/** Cosine of the steepest slope, 60°, that an entity is laid on. */
const STEEPEST_FLOOR = 0.5;

/** Where a thing with this box about its origin lies on a surface, in a picture of it before the server has said so: the place of its origin. */
export function restOn(bounds: Box3, point: Vector3, normal: Vector3, place: Vector3): Vector3 {
  place.copy(point);
  if (normal.y > STEEPEST_FLOOR) {
    place.y -= bounds.min.y;
    return place;
  }
  // At a wall or ceiling it is moved away from the surface by the depth that would be behind it.
  const half = bounds.getSize(new Vector3()).multiplyScalar(0.5);
  const reach = Math.abs(normal.x) * half.x + Math.abs(normal.y) * half.y + Math.abs(normal.z) * half.z;
  return place.addScaledVector(normal, reach).sub(bounds.getCenter(new Vector3()));
}
