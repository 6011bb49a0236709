// SPDX-License-Identifier: MIT
import { Box3, type BufferGeometry, type Material, Matrix4 } from "three";

/** One mesh of a drawable; `matrix` places it in the entity's frame. */
export interface DrawablePart {
  geometry: BufferGeometry;
  material: Material;
  matrix: Matrix4;
}

/** What an entity looks like, in its own frame. Shared by all entities that look the same. */
export interface Drawable {
  parts: DrawablePart[];
  bounds: Box3;
  castsShadow: boolean;
}

export function drawable(parts: DrawablePart[], castsShadow = true): Drawable {
  const bounds = new Box3();
  const partBounds = new Box3();
  for (const part of parts) {
    if (!part.geometry.boundingBox) part.geometry.computeBoundingBox();
    bounds.union(partBounds.copy(part.geometry.boundingBox!).applyMatrix4(part.matrix));
  }
  return { parts, bounds, castsShadow };
}

export function disposeDrawable(drawable: Drawable): void {
  for (const part of drawable.parts) {
    part.geometry.dispose();
    part.material.dispose();
  }
}
