// SPDX-License-Identifier: MIT
import { CanvasTexture, type Material, RepeatWrapping, type Texture, type WebGLProgramParametersWithUniforms } from "three";
import type { Finish } from "../connection/scene_types";

type Patterned = Exclude<Finish, "plain">;
/** The brightness, 0 … 1, that a pattern gives a point of its square, 0 … 1 each way; 0.8 leaves the colour as it is. */
type Pattern = (u: number, v: number) => number;

const SIDE = 256;
/** What leaves the colour as it is. */
const NEUTRAL = 0.8;
/** Side of the pattern's square, m. */
const SIZE: Record<Patterned, number> = { parquet: 1.2, tiles: 0.8, concrete: 2, plaster: 1, brick: 0.96, grass: 1.5, fabric: 0.12 };

/** Noise between 0 and 1 of `cells` hills a side, which goes on at the edges. */
function noise(u: number, v: number, cells: number, seed: number): number {
  const x = u * cells;
  const y = v * cells;
  const [column, row] = [Math.floor(x), Math.floor(y)];
  const ease = (part: number) => part * part * (3 - 2 * part);
  const [right, down] = [ease(x - column), ease(y - row)];
  const at = (c: number, r: number) => chance(((c % cells) + cells) % cells, ((r % cells) + cells) % cells, seed);
  const above = at(column, row) * (1 - right) + at(column + 1, row) * right;
  const below = at(column, row + 1) * (1 - right) + at(column + 1, row + 1) * right;
  return above * (1 - down) + below * down;
}

/** The same number between 0 and 1 each time. */
function chance(a: number, b: number, seed: number): number {
  let bits = Math.imul(a + 1, 374761393) ^ Math.imul(b + 1, 668265263) ^ Math.imul(seed + 1, 2147483647);
  bits = Math.imul(bits ^ (bits >>> 13), 1274126177);
  return ((bits ^ (bits >>> 16)) >>> 0) / 4294967296;
}

/** Several sizes of noise on each other. */
function clouds(u: number, v: number, cells: number, seed: number): number {
  return (4 * noise(u, v, cells, seed) + 2 * noise(u, v, 2 * cells, seed + 1) + noise(u, v, 4 * cells, seed + 2)) / 7;
}

/** Where a point lies in a rectangle of a grid whose odd rows are shifted by a part of a width. */
function bond(u: number, v: number, columns: number, rows: number, shift: number): { column: number; row: number; x: number; y: number } {
  const row = Math.floor(v * rows);
  const along = u * columns + (row % 2) * shift;
  const column = Math.floor(along);
  return { column: column % columns, row, x: along - column, y: v * rows - row };
}

const edge = (x: number, width: number) => Math.min(x, 1 - x) < width;

const PATTERNS: Record<Patterned, Pattern> = {
  parquet: (u, v) => {
    const { column, row, x, y } = bond(u, v, 2, 12, 0.37);
    if (edge(y, 0.03) || edge(x, 0.005)) return 0.42;
    return 0.66 + 0.22 * chance(column, row, 1) + 0.12 * (noise(u, v, 8, 2 + row) - 0.5) + 0.1 * (noise(u, v * 16, 32, 40 + row) - 0.5);
  },
  tiles: (u, v) => {
    const { column, row, x, y } = bond(u, v, 2, 2, 0);
    return edge(x, 0.012) || edge(y, 0.012) ? 0.5 : 0.79 + 0.05 * chance(column, row, 3) + 0.04 * (clouds(u, v, 8, 4) - 0.5);
  },
  concrete: (u, v) => 0.62 + 0.34 * clouds(u, v, 5, 5) + 0.06 * (noise(u, v, 128, 6) - 0.5),
  plaster: (u, v) => 0.74 + 0.12 * clouds(u, v, 24, 7),
  brick: (u, v) => {
    const { column, row, x, y } = bond(u, v, 4, 12, 0.5);
    return edge(x, 0.025) || edge(y, 0.08) ? 0.98 : 0.56 + 0.28 * chance(column, row, 8) + 0.14 * (noise(u, v, 64, 9) - 0.5);
  },
  grass: (u, v) => 0.42 + 0.4 * clouds(u, v, 12, 10) + 0.34 * (noise(u * 3, v, 96, 11) - 0.35),
  fabric: (u, v) => {
    const [x, y] = [(u * 12) % 1, (v * 12) % 1];
    const over = (Math.floor(u * 12) + Math.floor(v * 12)) % 2 === 0;
    const across = over ? x : y;
    return 0.58 + 0.34 * Math.sin(Math.PI * across) + 0.08 * (noise(u, v, 48, 12) - 0.5);
  },
};

const made = new Map<Patterned, Texture>();

function textureOf(finish: Patterned): Texture {
  let texture = made.get(finish);
  if (texture) return texture;
  const canvas = document.createElement("canvas");
  canvas.width = canvas.height = SIDE;
  const context = canvas.getContext("2d")!;
  const image = context.createImageData(SIDE, SIDE);
  for (let row = 0; row < SIDE; ++row)
    for (let column = 0; column < SIDE; ++column) {
      const bright = 255 * Math.min(1, Math.max(0, PATTERNS[finish]((column + 0.5) / SIDE, (row + 0.5) / SIDE)));
      image.data.set([bright, bright, bright, 255], 4 * (SIDE * row + column));
    }
  context.putImageData(image, 0, 0);
  texture = new CanvasTexture(canvas);
  texture.wrapS = texture.wrapT = RepeatWrapping;
  texture.anisotropy = 4;
  made.set(finish, texture);
  return texture;
}

/** Marks a material as having a finish; tintable() then draws it. */
export function setFinish(material: Material, finish: Finish | undefined): void {
  if (finish && finish !== "plain") material.userData["finish"] = finish;
}

/** The finish that a material was marked with. */
export function finishOf(material: Material): Patterned | null {
  return (material.userData["finish"] as Patterned | undefined) ?? null;
}

/** Draws the pattern on each side of the thing as large as it is in the world, over the thing's own colour. */
export function addFinish(shader: WebGLProgramParametersWithUniforms, finish: Patterned): void {
  shader.uniforms["finishMap"] = { value: textureOf(finish) };
  shader.uniforms["finishSize"] = { value: SIZE[finish] };
  shader.vertexShader = shader.vertexShader
    .replace("#include <common>", "#include <common>\nvarying vec3 vOwnPlace;\nvarying vec3 vOwnNormal;")
    .replace(
      "#include <begin_vertex>",
      `#include <begin_vertex>
      vec3 finishScale = vec3(length(instanceMatrix[0].xyz), length(instanceMatrix[1].xyz), length(instanceMatrix[2].xyz));
      vOwnPlace = position * finishScale;
      vOwnNormal = normal / finishScale;`,
    );
  shader.fragmentShader = shader.fragmentShader
    .replace("#include <common>", "#include <common>\nvarying vec3 vOwnPlace;\nvarying vec3 vOwnNormal;\nuniform sampler2D finishMap;\nuniform float finishSize;")
    .replace(
      "#include <map_fragment>",
      `#include <map_fragment>
      vec3 turnedTo = abs(vOwnNormal);
      vec2 finishPlace = turnedTo.y >= max(turnedTo.x, turnedTo.z) ? vOwnPlace.xz : turnedTo.x > turnedTo.z ? vOwnPlace.zy : vOwnPlace.xy;
      diffuseColor.rgb *= texture2D(finishMap, finishPlace / finishSize).r * ${(1 / NEUTRAL).toFixed(3)};`,
    );
}
