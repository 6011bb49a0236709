// SPDX-License-Identifier: MIT
// Debug frames: docs/protocol.md, "Debug frames".

const MAGIC = 0x44424d45; // "EMBD"
const VERSION = 1;
const HEADER_BYTES = 32;
const BATCH_BYTES = 12;
const LINE_FLOATS = 6;
const POINT_FLOATS = 3;

/** What debug.draw can show, in the order of the protocol. */
export const DEBUG_NAMES = ["shapes", "bounds", "contacts", "impulses", "islands", "joints", "masses", "particles", "deformables", "trees", "velocities", "forces"] as const;
export type DebugName = (typeof DEBUG_NAMES)[number];

/** Lines and points of the same meaning. */
export interface DebugBatch {
  meaning: number;
  dim: boolean;
  number: number;
  /** Start and end of each line, x y z. */
  lines: Float32Array;
  points: Float32Array;
}

export interface DebugFrame {
  time: number;
  linesLeftOut: number;
  pointsLeftOut: number;
  batches: DebugBatch[];
}

export function isDebugFrame(buffer: ArrayBuffer): boolean {
  return buffer.byteLength >= 4 && new DataView(buffer).getUint32(0, true) === MAGIC;
}

/** Reads a frame; throws with the reason when its version is another one. The numbers stay in the buffer. */
export function decodeDebugFrame(buffer: ArrayBuffer): DebugFrame {
  if (buffer.byteLength < HEADER_BYTES) throw new Error("debug frame shorter than its header");
  const view = new DataView(buffer);
  const version = view.getUint16(4, true);
  if (version !== VERSION) throw new Error(`debug frame of version ${version}, this Studio reads ${VERSION}`);
  const batches: DebugBatch[] = [];
  let at = HEADER_BYTES;
  for (let left = view.getUint32(12, true); left > 0; --left) {
    if (buffer.byteLength < at + BATCH_BYTES) throw new Error("debug frame cut short");
    const lineFloats = LINE_FLOATS * view.getUint32(at + 4, true);
    const pointFloats = POINT_FLOATS * view.getUint32(at + 8, true);
    const first = at + BATCH_BYTES;
    if (buffer.byteLength < first + 4 * (lineFloats + pointFloats)) throw new Error("debug frame cut short");
    batches.push({
      meaning: view.getUint8(at),
      dim: view.getUint8(at + 1) === 1,
      number: view.getUint16(at + 2, true),
      lines: new Float32Array(buffer, first, lineFloats),
      points: new Float32Array(buffer, first + 4 * lineFloats, pointFloats),
    });
    at = first + 4 * (lineFloats + pointFloats);
  }
  return { time: view.getFloat64(24, true), linesLeftOut: view.getUint32(16, true), pointsLeftOut: view.getUint32(20, true), batches };
}
