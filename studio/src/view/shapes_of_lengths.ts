// SPDX-License-Identifier: MIT
import { BoxGeometry, type BufferGeometry, CapsuleGeometry, ConeGeometry, CylinderGeometry, SphereGeometry } from "three";
import type { Shape, ShapeLengths, ShapeOfLengths, Vector } from "../connection/scene_types";
import { t } from "../language";

/** A length, or three along X, Y and Z, as a panel shows it: `factor` times the value of the scene file. */
interface LengthField<Name> {
  field: Name;
  label: string;
  /** Labels of the three lengths. */
  each?: [string, string, string];
  factor: 1 | 2;
}

interface Kind<Lengths> {
  label: string;
  /** A small drawing on a 32 × 32 grid. */
  drawing: string;
  /** Lengths of a new entity: the size of things that are held with two hands. */
  offered: Lengths;
  fields: readonly LengthField<keyof Lengths & string>[];
  /** The geometry, to be scaled by `size`. */
  draw(lengths: Lengths): { geometry: BufferGeometry; size: Vector };
}

const RADIUS = { field: "radius", label: t("Radius"), factor: 1 } as const;
const HEIGHT = { field: "half_height", label: t("Height"), factor: 2 } as const;

/** All shapes that are defined by their lengths alone: how each is drawn, sized and offered. */
export const SHAPES_OF_LENGTHS: { readonly [Type in keyof ShapeLengths]: Kind<ShapeLengths[Type]> } = {
  box: {
    label: t("Box"),
    drawing: "M6 11l10-5 10 5v11l-10 5-10-5zM6 11l10 5 10-5M16 16v11",
    offered: { half_extents: [0.2, 0.2, 0.2] },
    fields: [{ field: "half_extents", label: t("Size"), each: [t("Width"), t("Height"), t("Depth")], factor: 2 }],
    draw: ({ half_extents }) => ({ geometry: new BoxGeometry(2, 2, 2), size: half_extents }),
  },
  sphere: {
    label: t("Sphere"),
    drawing: "M16 6a10 10 0 1 0 0 20 10 10 0 0 0 0-20zM6 16c4 4.5 16 4.5 20 0",
    offered: { radius: 0.2 },
    fields: [RADIUS],
    draw: ({ radius }) => ({ geometry: new SphereGeometry(1, 32, 20), size: [radius, radius, radius] }),
  },
  capsule: {
    label: t("Capsule"),
    drawing: "M10 12a6 6 0 0 1 12 0v8a6 6 0 0 1-12 0zM10 12c2 2.5 10 2.5 12 0M10 20c2 2.5 10 2.5 12 0",
    offered: { radius: 0.12, half_height: 0.15 },
    fields: [RADIUS, { ...HEIGHT, label: t("Straight part") }],
    draw: ({ radius, half_height }) => ({ geometry: new CapsuleGeometry(radius, 2 * half_height, 10, 24, 1), size: [1, 1, 1] }),
  },
  cylinder: {
    label: t("Cylinder"),
    drawing: "M8 9c0-4 16-4 16 0v14c0 4-16 4-16 0zM8 9c0 4 16 4 16 0",
    offered: { radius: 0.2, half_height: 0.2 },
    fields: [RADIUS, HEIGHT],
    draw: ({ radius, half_height }) => ({ geometry: new CylinderGeometry(1, 1, 2, 40), size: [radius, half_height, radius] }),
  },
  cone: {
    label: t("Cone"),
    drawing: "M16 5l9 18c0 4-18 4-18 0zM7 23c0-3.5 18-3.5 18 0",
    offered: { radius: 0.2, half_height: 0.25 },
    fields: [RADIUS, HEIGHT],
    draw: ({ radius, half_height }) => ({ geometry: new ConeGeometry(1, 2, 40), size: [radius, half_height, radius] }),
  },
};

export function isOfLengths(shape: Shape): shape is ShapeOfLengths {
  return shape.type in SHAPES_OF_LENGTHS;
}

/** A type for code that treats all kinds alike. */
type Lengths = Record<string, number | Vector>;

function lengthsOf(shape: ShapeOfLengths): Lengths {
  return shape as unknown as Lengths;
}

function kindOf(shape: ShapeOfLengths): Kind<Lengths> {
  return SHAPES_OF_LENGTHS[shape.type] as unknown as Kind<Lengths>;
}

export function fieldsOf(shape: ShapeOfLengths): readonly LengthField<string>[] {
  return kindOf(shape).fields;
}

/** The geometry of the shape, to be scaled by `size`. */
export function drawingOf(shape: ShapeOfLengths): { geometry: BufferGeometry; size: Vector } {
  return kindOf(shape).draw(lengthsOf(shape));
}

/** The length that the panel shows. */
export function shownLength(shape: ShapeOfLengths, { field, factor }: LengthField<string>): number | Vector {
  return times(lengthsOf(shape)[field]!, factor);
}

/** The shape with a length that was entered in the panel. */
export function withShownLength(shape: ShapeOfLengths, { field, factor }: LengthField<string>, shown: number | Vector): ShapeOfLengths {
  return { ...shape, [field]: times(shown, 1 / factor) };
}

/** The shape with all lengths times the factor. */
export function scaledLengths(shape: ShapeOfLengths, factor: number): ShapeOfLengths {
  const scaled = fieldsOf(shape).map(({ field }) => [field, times(lengthsOf(shape)[field]!, factor)]);
  return { ...shape, ...Object.fromEntries(scaled) };
}

function times(length: number | Vector, factor: number): number | Vector {
  return typeof length === "number" ? length * factor : (length.map((each) => each * factor) as Vector);
}
