// SPDX-License-Identifier: MIT
import type { NewEntity } from "../connection/messages";
import type { Pose, Shape, ShapeOfLengths, Vector } from "../connection/scene_types";
import { SHAPES_OF_LENGTHS } from "../view/shapes_of_lengths";
import { t } from "../language";

export interface Primitive {
  name: string;
  label: string;
  /** A small drawing on a 32 × 32 grid. */
  drawing: string;
  entity: () => NewEntity;
}

function primitive(label: string, drawing: string, shape: Shape): Primitive {
  return { name: shape.type, label, drawing, entity: () => ({ shape }) };
}

/** A primitive whose physical kind is set. */
function ofKind(name: string, kind: string, label: string, drawing: string, shape: Shape, pose?: Pose): Primitive {
  return { name, label, drawing, entity: () => ({ name: label, shape, attributes: { kind }, ...(pose ? { pose } : {}) }) };
}

/** A primitive whose attributes follow from its category. */
function ofCategory(category: string, label: string, drawing: string, shape: Shape): Primitive {
  return { name: category, label, drawing, entity: () => ({ name: label, shape, category }) };
}

const STEEL: Vector = [0.6, 0.62, 0.65];
/** A column with a spout towards +Z, whose mouth is 6.5 cm above the middle, and a lever. */
const FAUCET: Shape = {
  type: "compound",
  children: [
    { type: "cylinder", radius: 0.022, half_height: 0.11 },
    { type: "box", half_extents: [0.012, 0.012, 0.075], position: [0, 0.098, 0.08] },
    { type: "cylinder", radius: 0.014, half_height: 0.015, position: [0, 0.08, 0.15] },
    { type: "box", half_extents: [0.008, 0.005, 0.04], position: [0, 0.118, -0.015] },
  ],
};

/** The primitives, at the size of things that are held with two hands. */
export const PRIMITIVES: readonly Primitive[] = [
  ...Object.entries(SHAPES_OF_LENGTHS).map(([type, { label, drawing, offered }]) => primitive(label, drawing, { type, ...offered } as ShapeOfLengths)),
  ofKind("cloth", "cloth", t("Cloth"), "M4 11c5-4 8 3 12 0s7-3 12 0l-2 13c-4-3-7 3-10 0s-7-3-12 0z", { type: "box", half_extents: [0.6, 0.001, 0.6] }),
  ofKind("round-cloth", "cloth", t("Round cloth"), "M4 14c0-8 24-8 24 0 0 3-2 8-4 10-2-3-4 2-8 0s-6 3-8 0c-2-2-4-7-4-10z", { type: "cylinder", radius: 0.6, half_height: 0.001 }),
  ofKind("rope", "rope", t("Rope"), "M4 9c4 0 4 14 12 14s8-14 12-14M4 12c3 0 4 14 12 14s9-14 12-14", { type: "capsule", radius: 0.01, half_height: 0.75 }, {
    rotation: [0, 0, Math.SQRT1_2, Math.SQRT1_2],
  }),
  ofKind("water", "fluid", t("Water"), "M16 5c5 7 8 10 8 14a8 8 0 0 1-16 0c0-4 3-7 8-14zM12 20a4 4 0 0 0 4 4", { type: "box", half_extents: [0.2, 0.2, 0.2] }),
  {
    name: "tap",
    label: t("Tap"),
    drawing: "M9 27V12a5 5 0 0 1 5-5h5a5 5 0 0 1 5 5v2M6 27h8M11 7V4M8 4h6M21 14h6M24 18v2M24 23v2",
    entity: () => ({ name: t("Tap"), shape: FAUCET, color: STEEL, attributes: { kind: "static" }, tap: { litres_per_minute: 30, radius: 0.012, speed: 0, position: [0, 0.05, 0.15], liquid: 0, open: true } }),
  },
  {
    name: "drain",
    label: t("Drain"),
    drawing: "M4 18c0-8 24-8 24 0s-24 8-24 0zM10 18c0-4 12-4 12 0s-12 4-12 0zM16 5v6M13 8l3 3 3-3",
    entity: () => ({ name: t("Drain"), shape: { type: "cylinder", radius: 0.035, half_height: 0.003 }, color: [0.1, 0.1, 0.11], attributes: { kind: "static" }, drain: { radius: 0.045, position: [0, 0, 0], open: true } }),
  },
  ofCategory("sand", t("Sand"), "M3 25c4-1 8-15 13-15s9 14 13 15zM11 20l.1 0M16 15l.1 0M16 21l.1 0M21 20l.1 0", { type: "cylinder", radius: 0.15, half_height: 0.12 }),
  ofCategory("cushion", t("Cushion"), "M5 9c4 2 18 2 22 0 1 4 1 11 0 15-4-2-18-2-22 0-1-4-1-11 0-15z", { type: "box", half_extents: [0.22, 0.08, 0.22] }),
  primitive(t("Plane"), "M3 20l8-8h18l-8 8zM16 16V7M16 7l-2.5 3M16 7l2.5 3", { type: "plane", normal: [0, 1, 0], offset: 0 }),
];
