// SPDX-License-Identifier: MIT
// State frames: docs/protocol.md, "Server → client: state frames".

const MAGIC = 0x46424d45; // "EMBF"
const VERSION = 1;
const HEADER_BYTES = 32;
const RECORD_BYTES = 36;

/** What the records of a frame say about one entity, seven floats each in `poses`: position x y z, rotation x y z w. */
export interface Frame {
  time: number;
  step: number;
  indices: Uint32Array;
  poses: Float32Array;
  states: Uint8Array;
}

export const POSE_FLOATS = 7;

/** Reads a frame; throws with the reason when it is not one of this version. */
export function decodeFrame(buffer: ArrayBuffer): Frame {
  if (buffer.byteLength < HEADER_BYTES) throw new Error("state frame shorter than its header");
  const view = new DataView(buffer);
  if (view.getUint32(0, true) !== MAGIC) throw new Error("state frame without its mark");
  const version = view.getUint16(4, true);
  if (version !== VERSION) throw new Error(`state frame of version ${version}, this Studio reads ${VERSION}`);
  const count = view.getUint32(8, true);
  if (buffer.byteLength < HEADER_BYTES + count * RECORD_BYTES) throw new Error("state frame cut short");

  const frame: Frame = {
    time: view.getFloat64(16, true),
    step: Number(view.getBigUint64(24, true)),
    indices: new Uint32Array(count),
    poses: new Float32Array(count * POSE_FLOATS),
    states: new Uint8Array(count),
  };
  for (let record = 0; record < count; ++record) {
    const at = HEADER_BYTES + record * RECORD_BYTES;
    frame.indices[record] = view.getUint32(at, true);
    for (let number = 0; number < POSE_FLOATS; ++number)
      frame.poses[record * POSE_FLOATS + number] = view.getFloat32(at + 4 + 4 * number, true);
    frame.states[record] = view.getUint8(at + 32);
  }
  return frame;
}

/** Gathers frames that nobody has looked at yet into one: per entity only the newest pose is kept. */
export class NewestFrame {
  private readonly records = new Map<number, { pose: Float32Array; state: number }>();
  private time = 0;
  private step = 0;
  private any = false;

  add(frame: Frame): void {
    this.any = true;
    this.time = frame.time;
    this.step = frame.step;
    for (let record = 0; record < frame.indices.length; ++record) {
      const pose = frame.poses.subarray(record * POSE_FLOATS, (record + 1) * POSE_FLOATS);
      this.records.set(frame.indices[record]!, { pose, state: frame.states[record]! });
    }
  }

  /** The gathered frame, or null when none came since the last call. */
  take(): Frame | null {
    if (!this.any) return null;
    const count = this.records.size;
    const frame: Frame = {
      time: this.time,
      step: this.step,
      indices: new Uint32Array(count),
      poses: new Float32Array(count * POSE_FLOATS),
      states: new Uint8Array(count),
    };
    let at = 0;
    for (const [index, record] of this.records) {
      frame.indices[at] = index;
      frame.poses.set(record.pose, at * POSE_FLOATS);
      frame.states[at] = record.state;
      ++at;
    }
    this.records.clear();
    this.any = false;
    return frame;
  }
}
