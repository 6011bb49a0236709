// SPDX-License-Identifier: MIT
import { BufferAttribute, BufferGeometry, Color, Group, LineBasicMaterial, LineSegments, type Material, Points, PointsMaterial } from "three";
import type { DebugBatch, DebugFrame } from "../connection/debug_frame";
import { Signal } from "../signal";

/** Size of a point on the page, in pixels. */
const POINT_SIZE = 5;
/** Brightness of lines and points of sleeping bodies, or that matter less. */
const DIMMED = 0.4;
/** Colours by meaning, as docs/protocol.md numbers them; null: a colour for each number. */
const COLORS: readonly (number | null)[] = [
  0x6f86a0, 0x9a7fd0, 0xff5a4d, 0x4fd36b, 0x9aa0a6, 0xd8b04a, 0xffd23e, 0x4dc3ff, 0xff8a3c, null, 0xe6e6e6, null, 0xff6ad5, 0xffffff, null, 0x38a6ff, 0xffe08a, 0x7fd1c0, 0xff9ad0, null, 0x6cff9a, null,
];
/** Colours of the axes X, Y and Z. */
const AXIS_COLORS = [0xff4d4d, 0x5fdc5f, 0x5a8dff];
const AXIS_MEANINGS = [11, 14];
/** Colours of weight, constant force and forces of contacts. */
const FORCE_COLORS = [0xff5a4d, 0xd08cff, 0xff9f3c];
const FORCE_MEANING = 21;

/** Debug drawings of the solver, over the picture. */
export class DebugOverlay {
  readonly group = new Group();
  private readonly lines = new LineSegments(new BufferGeometry(), new LineBasicMaterial({ vertexColors: true, depthTest: false, transparent: true }));
  private readonly points = new Points(
    new BufferGeometry(),
    new PointsMaterial({ vertexColors: true, depthTest: false, transparent: true, size: POINT_SIZE, sizeAttenuation: false }),
  );
  /** Lines and points of each meaning that are drawn, for tests. */
  counts: Record<number, { lines: number; points: number }> = {};
  /** Lines and points that the frame left out because its size is limited. */
  leftOut = { lines: 0, points: 0 };
  /** Another frame is drawn, or none. */
  readonly changed = new Signal<void>();

  constructor() {
    for (const object of [this.lines, this.points]) {
      object.frustumCulled = false;
      object.renderOrder = 992;
      object.raycast = () => {};
      (object.material as Material).toneMapped = false;
      this.group.add(object);
    }
    this.show(null);
  }

  /** Draws exactly this frame; null: nothing. */
  show(frame: DebugFrame | null): void {
    const batches = frame?.batches ?? [];
    this.counts = {};
    for (const { meaning, lines, points } of batches) {
      const count = (this.counts[meaning] ??= { lines: 0, points: 0 });
      count.lines += lines.length / 6;
      count.points += points.length / 3;
    }
    fill(this.lines, batches, ({ lines }) => lines);
    fill(this.points, batches, ({ points }) => points);
    this.leftOut = { lines: frame?.linesLeftOut ?? 0, points: frame?.pointsLeftOut ?? 0 };
    this.changed.emit();
  }
}

function fill(object: LineSegments | Points, batches: readonly DebugBatch[], placesOf: (batch: DebugBatch) => Float32Array): void {
  const floats = batches.reduce((sum, batch) => sum + placesOf(batch).length, 0);
  const places = new Float32Array(floats);
  const colors = new Float32Array(floats);
  let at = 0;
  for (const batch of batches) {
    const batchPlaces = placesOf(batch);
    places.set(batchPlaces, at);
    const { r, g, b } = colorOf(batch);
    for (const end = at + batchPlaces.length; at < end; at += 3) colors.set([r, g, b], at);
  }
  object.geometry.dispose();
  object.geometry = new BufferGeometry().setAttribute("position", new BufferAttribute(places, 3)).setAttribute("color", new BufferAttribute(colors, 3));
  object.visible = floats > 0;
}

function colorOf({ meaning, dim, number }: DebugBatch): Color {
  const known = AXIS_MEANINGS.includes(meaning) ? AXIS_COLORS[number % 3] : meaning === FORCE_MEANING ? FORCE_COLORS[number % 3] : COLORS[meaning];
  const color = known == null ? new Color().setHSL((0.08 + number * 0.381966) % 1, 0.8, 0.6) : new Color(known);
  return dim ? color.multiplyScalar(DIMMED) : color;
}
