// SPDX-License-Identifier: MIT
// Makes the surfaces of liquids outside of the page's thread: for 60,000 particles it takes longer than a frame may.
import type { PointSet } from "../connection/frame";
import type { LiquidMesh } from "./liquid_mesh";
import { LiquidMesher } from "./liquid_mesher";

/** Page → worker. */
export type ToLiquidWorker =
  | { kind: "points"; set: PointSet }
  /** Asks for a mesh of the points after this fraction of their movement to the last set's positions. */
  | { kind: "mesh"; index: number; part: number }
  | { kind: "forget"; index: number };
/** Worker → page: the mesh that was asked for. */
export interface FromLiquidWorker extends LiquidMesh {
  index: number;
}

interface Points {
  from: Float32Array;
  to: Float32Array;
  now: Float32Array;
  spacing: number;
}

const known = new Map<number, Points>();
const mesher = new LiquidMesher();

/** Edge of the cube that has a ball's volume, per radius. */
const CUBE = Math.cbrt((4 / 3) * Math.PI);

function take(set: PointSet): void {
  const to = new Float32Array(set.positions.length);
  for (let at = 0; at < to.length; ++at) to[at] = set.lower[at % 3]! + (set.size[at % 3]! * set.positions[at]!) / 65535;
  const before = known.get(set.index);
  const isSame = before?.to.length === to.length;
  const from = isSame ? before.now : to;
  known.set(set.index, { from, to, now: from.slice(), spacing: CUBE * set.radius });
}

function mesh(index: number, part: number): void {
  const points = known.get(index);
  if (!points) return;
  const { from, to, now } = points;
  for (let at = 0; at < to.length; ++at) now[at] = from[at]! + part * (to[at]! - from[at]!);
  const made = mesher.build(now, points.spacing);
  const message: FromLiquidWorker = { index, ...made };
  postMessage(message, { transfer: [made.positions.buffer, made.normals.buffer, made.indices.buffer, made.thickness.buffer] });
}

onmessage = (event: MessageEvent<ToLiquidWorker>) => {
  const message = event.data;
  if (message.kind === "points") take(message.set);
  else if (message.kind === "mesh") mesh(message.index, message.part);
  else known.delete(message.index);
};
