// SPDX-License-Identifier: MIT
// Generated models for tests.

/** A PNG picture of one pixel. */
export const PIXEL = Buffer.from("iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAYAAAAfFcSJAAAADUlEQVR4nGPY0ODwHwAFxAJwjEci1QAAAABJRU5ErkJggg==", "base64");

/** A binary glTF of a box of 0.5 m with its origin in its base; with a texture if asked for. */
export function boxGlb({ textured = false } = {}) {
  const corners = [], places = [];
  for (const x of [-0.25, 0.25]) for (const y of [0, 0.5]) for (const z of [-0.25, 0.25]) {
    corners.push(x, y, z);
    places.push(x + 0.25, z + 0.25);
  }
  const faces = [0, 1, 3, 0, 3, 2, 4, 6, 7, 4, 7, 5, 0, 4, 5, 0, 5, 1, 2, 3, 7, 2, 7, 6, 0, 2, 6, 0, 6, 4, 1, 5, 7, 1, 7, 3];
  const parts = [Buffer.from(new Float32Array(corners).buffer), Buffer.from(new Uint16Array(faces).buffer)];
  if (textured) parts.push(Buffer.from(new Float32Array(places).buffer), PIXEL, Buffer.alloc((4 - (PIXEL.length % 4)) % 4));
  const bufferViews = [];
  let byteOffset = 0;
  for (const part of parts) {
    bufferViews.push({ buffer: 0, byteOffset, byteLength: part.length });
    byteOffset += part.length;
  }
  const color = textured ? { baseColorTexture: { index: 0 } } : { baseColorFactor: [0.6, 0.35, 0.15, 1] };
  const json = {
    asset: { version: "2.0" },
    scene: 0,
    scenes: [{ nodes: [0] }],
    nodes: [{ mesh: 0 }],
    meshes: [{ primitives: [{ attributes: { POSITION: 0, ...(textured && { TEXCOORD_0: 2 }) }, indices: 1, material: 0 }] }],
    materials: [{ pbrMetallicRoughness: { ...color, metallicFactor: 0 } }],
    ...(textured && { textures: [{ source: 0 }], images: [{ bufferView: 3, mimeType: "image/png" }] }),
    accessors: [
      { bufferView: 0, componentType: 5126, count: 8, type: "VEC3", min: [-0.25, 0, -0.25], max: [0.25, 0.5, 0.25] },
      { bufferView: 1, componentType: 5123, count: faces.length, type: "SCALAR" },
      ...(textured ? [{ bufferView: 2, componentType: 5126, count: 8, type: "VEC2" }] : []),
    ],
    bufferViews,
    buffers: [{ byteLength: byteOffset }],
  };
  let text = JSON.stringify(json);
  text += " ".repeat((4 - (text.length % 4)) % 4);
  const chunk = (type, data) => {
    const head = Buffer.alloc(8);
    head.writeUInt32LE(data.length, 0);
    head.write(type, 4, "latin1");
    return Buffer.concat([head, data]);
  };
  const chunks = Buffer.concat([chunk("JSON", Buffer.from(text)), chunk("BIN\0", Buffer.concat(parts))]);
  const head = Buffer.alloc(12);
  head.write("glTF", 0, "latin1");
  head.writeUInt32LE(2, 4);
  head.writeUInt32LE(12 + chunks.length, 8);
  return Buffer.concat([head, chunks]);
}
