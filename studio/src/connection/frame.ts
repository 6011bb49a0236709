// SPDX-License-Identifier: MIT
// State frames: docs/protocol.md, "Server → client: state frames".

const MAGIC = 0x46424d45; // "EMBF"
const VERSION = 2;
const HEADER_BYTES = 32;
const RECORD_BYTES = 36;
const SET_HEAD_BYTES = 40;

/** What the records of a frame say about one entity, seven floats each in `poses`: position x y z, rotation x y z w. */
export interface Frame {
  time: number;
  step: number;
  indices: Uint32Array;
  poses: Float32Array;
  states: Uint8Array;
  /** 1 where the entity has points. */
  pointed: Uint8Array;
  /** Points that moved, of entities that are not one body. */
  sets: PointSet[];
}

/** Points of one entity: grains, or nodes of a deformable thing. */
export interface PointSet {
  index: number;
  /** Minimum corner and size of the box around the points, m, world. */
  lower: [number, number, number];
  size: [number, number, number];
  /** Radius of the ball at each point, m; 0: the points carry the entity's drawn form. */
  radius: number;
  /** The points are particles of a liquid: its surface is drawn. */
  liquid: boolean;
  /** Three numbers for each point, in 65535ths of the box. */
  positions: Uint16Array;
}

export const POSE_FLOATS = 7;

/** Reads a frame; throws with the reason when its version is another one. */
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
    pointed: new Uint8Array(count),
    sets: decodeSets(buffer, HEADER_BYTES + count * RECORD_BYTES, view.getUint32(12, true)),
  };
  for (let record = 0; record < count; ++record) {
    const at = HEADER_BYTES + record * RECORD_BYTES;
    frame.indices[record] = view.getUint32(at, true);
    for (let number = 0; number < POSE_FLOATS; ++number)
      frame.poses[record * POSE_FLOATS + number] = view.getFloat32(at + 4 + 4 * number, true);
    frame.states[record] = view.getUint8(at + 32);
    frame.pointed[record] = view.getUint8(at + 33);
  }
  return frame;
}

function decodeSets(buffer: ArrayBuffer, start: number, count: number): PointSet[] {
  const view = new DataView(buffer);
  const sets: PointSet[] = [];
  let at = start;
  for (let set = 0; set < count; ++set) {
    if (buffer.byteLength < at + SET_HEAD_BYTES) throw new Error("state frame cut short");
    const number = (which: number) => view.getFloat32(at + 8 + 4 * which, true);
    const points = view.getUint32(at + 4, true);
    const first = at + SET_HEAD_BYTES;
    const end = first + 6 * points;
    if (buffer.byteLength < end) throw new Error("state frame cut short");
    sets.push({
      index: view.getUint32(at, true),
      lower: [number(0), number(1), number(2)],
      size: [number(3), number(4), number(5)],
      radius: number(6),
      liquid: view.getUint32(at + 36, true) === 1,
      positions: new Uint16Array(buffer.slice(first, end)),
    });
    at = end + (end % 4);
  }
  return sets;
}

/** Merges frames that have not been used yet into one: only the newest pose of each entity is kept. */
export class NewestFrame {
  private readonly records = new Map<number, { pose: Float32Array; state: number; pointed: number }>();
  private readonly sets = new Map<number, PointSet>();
  private time = 0;
  private step = 0;
  private any = false;

  add(frame: Frame): void {
    this.any = true;
    this.time = frame.time;
    this.step = frame.step;
    for (let record = 0; record < frame.indices.length; ++record) {
      const pose = frame.poses.subarray(record * POSE_FLOATS, (record + 1) * POSE_FLOATS);
      this.records.set(frame.indices[record]!, { pose, state: frame.states[record]!, pointed: frame.pointed[record]! });
      if (!frame.pointed[record]) this.sets.delete(frame.indices[record]!);
    }
    for (const set of frame.sets) this.sets.set(set.index, set);
  }

  /** The merged frame, or null when none came since the last call. */
  take(): Frame | null {
    if (!this.any) return null;
    const count = this.records.size;
    const frame: Frame = {
      time: this.time,
      step: this.step,
      indices: new Uint32Array(count),
      poses: new Float32Array(count * POSE_FLOATS),
      states: new Uint8Array(count),
      pointed: new Uint8Array(count),
      sets: [...this.sets.values()],
    };
    let at = 0;
    for (const [index, record] of this.records) {
      frame.indices[at] = index;
      frame.poses.set(record.pose, at * POSE_FLOATS);
      frame.states[at] = record.state;
      frame.pointed[at] = record.pointed;
      ++at;
    }
    this.records.clear();
    this.sets.clear();
    this.any = false;
    return frame;
  }
}
