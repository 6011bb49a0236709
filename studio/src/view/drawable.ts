// SPDX-License-Identifier: MIT
import { Box3, type BufferAttribute, type BufferGeometry, Color, type Material, Matrix4, type MeshStandardMaterial, SRGBColorSpace } from "three";

/** One mesh of a drawable; `matrix` places it in the entity's frame. */
export interface DrawablePart {
  geometry: BufferGeometry;
  material: Material;
  matrix: Matrix4;
  /** Triangles of the coarser levels of detail; null: the part is too small to be seen on that level. */
  levels?: (BufferAttribute | null)[];
  /** Of a part whose vertices have colours: the colours. */
  colors?: readonly Color[];
}

/** What an entity looks like, in its own frame. Shared by all entities that look the same. */
export interface Drawable {
  parts: DrawablePart[];
  bounds: Box3;
  castsShadow: boolean;
  /** How far each coarser level's surface may be from the full one, m; none: there is full detail alone. */
  levelErrors?: readonly number[];
  /** From this level on (1 is the first coarser one) these parts are drawn: textures are one colour there. */
  far?: { from: number; parts: DrawablePart[] };
  /** Its vertices move, so that its box at rest does not tell where it is. */
  bends?: boolean;
  /** Faces are drawn from both sides. */
  hasTwoSides?: boolean;
  /** It is cloth: its folds have faces seen edge-on everywhere. */
  isCloth?: boolean;
}

/** Whether a geometry is a closed surface: each edge belongs to two triangles, in opposite directions. */
export function isClosed(geometry: BufferGeometry): boolean {
  const position = geometry.getAttribute("position");
  const count = geometry.index?.count ?? position.count;
  // Vertices with different normals can have the same position.
  const places = new Map<string, number>();
  const placeOf = (corner: number): number => {
    const v = geometry.index?.getX(corner) ?? corner;
    const key = `${position.getX(v)} ${position.getY(v)} ${position.getZ(v)}`;
    const known = places.get(key);
    if (known !== undefined) return known;
    places.set(key, places.size);
    return places.size - 1;
  };
  const open = new Map<number, number>();
  for (let corner = 0; corner + 2 < count; corner += 3) {
    const at = [placeOf(corner), placeOf(corner + 1), placeOf(corner + 2)];
    at.forEach((from, k) => {
      const to = at[(k + 1) % 3]!;
      const key = Math.min(from, to) * position.count + Math.max(from, to);
      open.set(key, (open.get(key) ?? 0) + Math.sign(to - from));
    });
  }
  return [...open.values()].every((ways) => ways === 0);
}

/** The triangles of the coarsest level whose surface is nearer than `error`, m, to the full one; null: all vertices in turn. */
export function coarseIndexOf(drawable: Drawable, part: DrawablePart, error: number): BufferAttribute | null {
  const { levelErrors = [] } = drawable;
  let level = levelErrors.length;
  while (level > 0 && levelErrors[level - 1]! > error) --level;
  return (level > 0 ? part.levels?.[level - 1] : null) ?? part.geometry.index;
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

/** Disposes of the geometries of a drawable whose materials belong to another one. */
export function disposeGeometries(drawable: Drawable): void {
  for (const part of drawable.parts) part.geometry.dispose();
}

export function disposeDrawable(drawable: Drawable): void {
  for (const part of drawable.parts) {
    part.geometry.dispose();
    part.material.dispose();
  }
}

/** The colour of a part; of one whose vertices have colours, their mean. */
function colorOfPart({ material, colors }: DrawablePart): Color {
  if (!colors) return (material as MeshStandardMaterial).color?.clone() ?? new Color(1, 1, 1);
  const sum = new Color(0, 0, 0);
  for (const color of colors) sum.add(color);
  return sum.multiplyScalar(1 / colors.length);
}

/** The mean of the parts' colours, with textures: for an entity that is drawn as points. */
export function averageColor(drawable: Drawable): Color {
  const sum = new Color(0, 0, 0);
  for (const part of drawable.parts) {
    const { map } = part.material as MeshStandardMaterial;
    const own = colorOfPart(part);
    if (map?.image) own.multiply(averageOf(map.image as CanvasImageSource));
    sum.add(own);
  }
  return sum.multiplyScalar(1 / Math.max(1, drawable.parts.length));
}

/** The mean colour of a texture's image. */
export function averageOf(image: CanvasImageSource): Color {
  const canvas = document.createElement("canvas");
  canvas.width = canvas.height = 1;
  // Kept in memory: a canvas on the graphics card would wait for all that is being drawn there.
  const context = canvas.getContext("2d", { willReadFrequently: true });
  if (!context) return new Color(1, 1, 1);
  context.imageSmoothingQuality = "high";
  context.drawImage(image, 0, 0, 1, 1);
  const [red, green, blue] = context.getImageData(0, 0, 1, 1).data;
  return new Color().setRGB(red! / 255, green! / 255, blue! / 255, SRGBColorSpace);
}
