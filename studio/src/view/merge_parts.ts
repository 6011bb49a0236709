// SPDX-License-Identifier: MIT
import { BufferAttribute, BufferGeometry, InterleavedBuffer, InterleavedBufferAttribute, MeshStandardMaterial, type TypedArray } from "three";
import { averageOf, type DrawablePart } from "./drawable";

/** Vertex numbers above this need 32 bits. */
const LAST_SHORT = 65535;

/**
 * Parts that differ in nothing but colour, roughness and metalness become one, which has these at its vertices: most models are
 * then drawn with one call. What has a texture, lets light through or glows stays a part of its own.
 */
export function mergeParts(parts: readonly DrawablePart[]): DrawablePart[] {
  const alike = new Map<string, DrawablePart[]>();
  const result: DrawablePart[] = [];
  for (const part of parts) {
    if (!isPlain(part)) {
      result.push(part);
      continue;
    }
    const key = `${part.material.side} ${part.matrix.elements.join(" ")}`;
    const group = alike.get(key);
    if (group) group.push(part);
    else alike.set(key, [part]);
  }
  for (const group of alike.values()) result.push(group.length > 1 ? merged(group) : group[0]!);
  return result;
}

function isPlain({ geometry, material }: DrawablePart, withTexture = false): boolean {
  if (!(material instanceof MeshStandardMaterial) || !geometry.index) return false;
  const { position, normal, color } = geometry.attributes;
  const isOurs = position?.array instanceof Uint16Array && normal?.array instanceof Int8Array && !color;
  return isOurs && (withTexture || !material.map) && !material.transparent && material.alphaTest === 0 && material.emissive.getHex() === 0;
}

function merged(parts: readonly DrawablePart[]): DrawablePart {
  const vertices = parts.reduce((sum, { geometry }) => sum + geometry.getAttribute("position").count, 0);
  const positions = new Uint16Array(4 * vertices);
  const normals = new Int8Array(4 * vertices);
  const surfaces = new Uint16Array(4 * vertices);
  let vertex = 0;
  for (const { geometry, material } of parts) {
    const position = geometry.getAttribute("position");
    const normal = geometry.getAttribute("normal");
    const { color, roughness, metalness } = material as MeshStandardMaterial;
    const [red, green, blue] = color.toArray().map((value) => Math.round(value * 65535)) as [number, number, number];
    const rough = 256 * Math.round(roughness * 255) + Math.round(metalness * 255);
    for (let i = 0, at = 4 * vertex; i < position.count; ++i, at += 4) {
      positions[at] = position.getX(i);
      positions[at + 1] = position.getY(i);
      positions[at + 2] = position.getZ(i);
      normals[at] = Math.round(127 * normal.getX(i));
      normals[at + 1] = Math.round(127 * normal.getY(i));
      normals[at + 2] = Math.round(127 * normal.getZ(i));
      surfaces[at] = red;
      surfaces[at + 1] = green;
      surfaces[at + 2] = blue;
      surfaces[at + 3] = rough;
    }
    vertex += position.count;
  }

  const geometry = new BufferGeometry();
  geometry.setAttribute("position", fieldOf(positions, 3, 0, false));
  geometry.setAttribute("normal", fieldOf(normals, 3, 0, true));
  const surface = new InterleavedBuffer(surfaces, 4);
  geometry.setAttribute("color", new InterleavedBufferAttribute(surface, 3, 0, true));
  geometry.setAttribute("surface", new InterleavedBufferAttribute(surface, 1, 3, true));
  geometry.setIndex(joined(parts, parts.map((part) => part.geometry.index), vertices));
  const material = new MeshStandardMaterial({ vertexColors: true, side: parts[0]!.material.side });
  // Its vertices say how rough and metallic it is (tint.ts).
  material.userData["surfaceAtVertices"] = true;
  const levels = parts[0]!.levels?.map((_, level) => joined(parts, parts.map((part) => part.levels?.[level] ?? null), vertices));
  const colors = parts.map((part) => (part.material as MeshStandardMaterial).color);
  return { geometry, material, matrix: parts[0]!.matrix, colors, ...(levels && { levels }) };
}

function fieldOf(array: TypedArray, itemSize: number, offset: number, normalized: boolean): InterleavedBufferAttribute {
  return new InterleavedBufferAttribute(new InterleavedBuffer(array, 4), itemSize, offset, normalized);
}

/** One list of the parts' triangles; null where there are none. */
function joined(parts: readonly DrawablePart[], indices: readonly (BufferAttribute | null)[], vertices: number): BufferAttribute | null {
  const count = indices.reduce((sum, index) => sum + (index?.count ?? 0), 0);
  if (count === 0) return null;
  const all = vertices > LAST_SHORT ? new Uint32Array(count) : new Uint16Array(count);
  let at = 0;
  let first = 0;
  parts.forEach((part, which) => {
    const index = indices[which];
    for (let i = 0; i < (index?.count ?? 0); ++i) all[at++] = first + index!.getX(i);
    first += part.geometry.getAttribute("position").count;
  });
  return new BufferAttribute(all, 1);
}

/** This many of the coarsest levels are so small on the screen that a texture is one colour. */
const FAR_LEVELS = 2;

/** The parts of what is seen from afar: textured ones have their mean colour, so that they merge with the others. Null where that saves nothing. */
export function farParts(parts: readonly DrawablePart[], levels: number): { from: number; parts: DrawablePart[] } | null {
  const from = levels - FAR_LEVELS + 1;
  const isFlat = (part: DrawablePart) => part.levels !== undefined && isPlain(part, true);
  if (from < 1 || parts.filter(isFlat).length < 2 || !parts.some((part) => isFlat(part) && !isPlain(part))) return null;
  return { from, parts: mergeParts(parts.map((part) => (isFlat(part) ? flattened(part, from) : part))) };
}

/** A part's coarsest levels on a copy of the vertices that they have, in one colour. */
function flattened({ geometry, material, matrix, levels }: DrawablePart, from: number): DrawablePart {
  const { color, roughness, metalness, map, side } = material as MeshStandardMaterial;
  const position = geometry.getAttribute("position");
  const normal = geometry.getAttribute("normal");
  const newOf = new Map<number, number>();
  const few = levels!.map((index, level) => {
    if (level + 1 < from || !index) return null;
    return new BufferAttribute(Uint32Array.from(index.array, (vertex) => newOf.get(vertex) ?? (newOf.set(vertex, newOf.size), newOf.size - 1)), 1);
  });
  const positions = new Uint16Array(4 * newOf.size);
  const normals = new Int8Array(4 * newOf.size);
  for (const [old, vertex] of newOf)
    for (let k = 0; k < 3; ++k) {
      positions[4 * vertex + k] = position.getComponent(old, k);
      normals[4 * vertex + k] = Math.round(127 * normal.getComponent(old, k));
    }
  const copy = new BufferGeometry();
  copy.setAttribute("position", fieldOf(positions, 3, 0, false));
  copy.setAttribute("normal", fieldOf(normals, 3, 0, true));
  copy.setIndex(few[from - 1] ?? new BufferAttribute(new Uint32Array(0), 1));
  const mean = color.clone();
  if (map?.image) mean.multiply(averageOf(map.image as CanvasImageSource));
  return { geometry: copy, material: new MeshStandardMaterial({ color: mean, roughness, metalness, side }), matrix, levels: few };
}
