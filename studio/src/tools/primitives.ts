// SPDX-License-Identifier: MIT
import type { NewEntity } from "../connection/messages";
import type { Shape } from "../document/scene_types";

export interface Primitive {
  name: Shape["type"];
  label: string;
  /** A small drawing on a 32 × 32 grid. */
  drawing: string;
  entity: () => NewEntity;
}

function primitive(label: string, drawing: string, shape: Shape): Primitive {
  return { name: shape.type, label, drawing, entity: () => ({ shape }) };
}

/** The analytical models, at the size of things one holds in two hands. */
export const PRIMITIVES: readonly Primitive[] = [
  primitive("Box", "M6 11l10-5 10 5v11l-10 5-10-5zM6 11l10 5 10-5M16 16v11", { type: "box", half_extents: [0.2, 0.2, 0.2] }),
  primitive("Sphere", "M16 6a10 10 0 1 0 0 20 10 10 0 0 0 0-20zM6 16c4 4.5 16 4.5 20 0", { type: "sphere", radius: 0.2 }),
  primitive("Capsule", "M10 12a6 6 0 0 1 12 0v8a6 6 0 0 1-12 0zM10 12c2 2.5 10 2.5 12 0M10 20c2 2.5 10 2.5 12 0", { type: "capsule", radius: 0.12, half_height: 0.15 }),
  primitive("Cylinder", "M8 9c0-4 16-4 16 0v14c0 4-16 4-16 0zM8 9c0 4 16 4 16 0", { type: "cylinder", radius: 0.2, half_height: 0.2 }),
  primitive("Cone", "M16 5l9 18c0 4-18 4-18 0zM7 23c0-3.5 18-3.5 18 0", { type: "cone", radius: 0.2, half_height: 0.25 }),
  primitive("Plane", "M3 20l8-8h18l-8 8zM16 16V7M16 7l-2.5 3M16 7l2.5 3", { type: "plane", normal: [0, 1, 0], offset: 0 }),
];
