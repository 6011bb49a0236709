// SPDX-License-Identifier: MIT
// The scene file (docs/scene-format.md) as far as the Studio reads it. What is missing has the format's default.

export type Vector = [number, number, number];
export type Quaternion = [number, number, number, number];

export interface Pose {
  position?: Vector;
  rotation?: Quaternion;
}

/** Lengths in metres; round shapes have their axis along Y and are centred on the origin. */
export type ConvexShape =
  | { type: "sphere"; radius: number }
  | { type: "box"; half_extents: Vector }
  | { type: "capsule" | "cylinder" | "cone"; radius: number; half_height: number }
  | { type: "hull"; points: Vector[] };

export type Shape =
  | ConvexShape
  | { type: "plane"; normal?: Vector; offset?: number }
  | { type: "heightfield"; columns: number; rows: number; cell_x?: number; cell_z?: number; heights: number[] }
  | { type: "mesh"; positions: Vector[]; triangles: Vector[] }
  | { type: "compound"; children: (ConvexShape & Pose)[] };

/** Where something that bends is held: its nodes at rest within the radius, or the nearest. */
export interface Pin {
  position?: Vector;
  radius?: number;
  /** The entity that it goes with; without, the world. */
  to?: number;
  /** Of a rope: holds its direction and twist too. */
  clamped?: boolean;
}

export interface Entity {
  index: number;
  name?: string;
  /** Either a model of the database by its key … */
  model?: string;
  /** … or a primitive. */
  shape?: Shape;
  attributes?: Record<string, unknown>;
  pose?: Pose;
  linear_velocity?: Vector;
  angular_velocity?: Vector;
  force?: Vector;
  torque?: Vector;
  pins?: Pin[];
  enabled?: boolean;
  start_asleep?: boolean;
  allow_sleep?: boolean;
  continuous?: boolean;
  category?: string;
  color?: Vector | null;
  scale?: number;
}

export interface Joint {
  index: number;
  name?: string;
  type?: string;
  entity_a?: number;
  entity_b: number;
}

export interface Action {
  id: number;
  name?: string;
  trigger?: { type?: string; key?: string; button?: string };
}

export interface SceneSettings {
  gravity: Vector;
  time_step: number;
  substeps: number;
  sleeping: boolean;
  time_to_sleep: number;
  shock_propagation: boolean;
  wind: Vector;
  gustiness: number;
  gust_time: number;
  air_density: number;
}

export interface Scene {
  title?: string;
  description?: string;
  settings?: Partial<SceneSettings>;
  entities?: Entity[];
  joints?: Joint[];
  actions?: Action[];
  camera?: { position: Vector; target: Vector };
}
