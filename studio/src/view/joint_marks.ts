// SPDX-License-Identifier: MIT
import { BufferAttribute, BufferGeometry, Color, Group, LineBasicMaterial, LineSegments, Points, PointsMaterial, Vector3 } from "three";

/** A joint in the world: where it is, along what it turns or slides, and the middles of what it holds. */
export interface JointMark {
  anchor: Vector3;
  /** Unit vector; null for joints without one. */
  axis: Vector3 | null;
  ends: readonly Vector3[];
  chosen: boolean;
}

const COLOR = new Color(0x35c6e8);
const CHOSEN = new Color(0xffc24a);
const TIE = new Color(0x8fa3b3);
/** Length of an axis beside the camera's distance. */
const AXIS_SHARE = 0.09;

/** Joints over the picture: a dot at the anchor, an arrow along the axis, lines to what it holds. */
export class JointMarks {
  readonly group = new Group();
  private readonly lines = new LineSegments(new BufferGeometry(), new LineBasicMaterial({ vertexColors: true, depthTest: false, transparent: true }));
  private readonly points = new Points(new BufferGeometry(), new PointsMaterial({ vertexColors: true, size: 9, sizeAttenuation: false, depthTest: false, transparent: true }));

  constructor() {
    for (const object of [this.lines, this.points]) {
      object.frustumCulled = false;
      object.renderOrder = 994;
      object.raycast = () => {};
      object.material.toneMapped = false;
      this.group.add(object);
    }
    this.show([], new Vector3());
  }

  /** Draws exactly these, for an eye here. */
  show(marks: readonly JointMark[], eye: Vector3): void {
    // Most pictures have none: they make no buffers.
    if (marks.length === 0 && !this.group.visible) return;
    const places: Vector3[] = [];
    const colors: Color[] = [];
    const line = (from: Vector3, to: Vector3, color: Color) => (places.push(from, to), colors.push(color, color));
    for (const { anchor, axis, ends, chosen } of marks) {
      const color = chosen ? CHOSEN : COLOR;
      for (const end of ends) line(end, anchor, TIE);
      if (!axis) continue;
      const length = AXIS_SHARE * Math.max(anchor.distanceTo(eye), 0.1);
      const tip = anchor.clone().addScaledVector(axis, length);
      const aside = new Vector3(-axis.y, axis.z, axis.x).cross(axis).setLength(0.2 * length);
      const neck = anchor.clone().addScaledVector(axis, 0.75 * length);
      line(anchor.clone().addScaledVector(axis, -length), tip, color);
      line(tip, neck.clone().add(aside), color);
      line(tip, neck.sub(aside), color);
    }
    put(this.lines.geometry, places, colors);
    put(this.points.geometry, marks.map(({ anchor }) => anchor), marks.map(({ chosen }) => (chosen ? CHOSEN : COLOR)));
    this.group.visible = marks.length > 0;
  }
}

function put(geometry: BufferGeometry, places: readonly Vector3[], colors: readonly Color[]): void {
  geometry.setAttribute("position", new BufferAttribute(new Float32Array(places.flatMap((place) => place.toArray())), 3));
  geometry.setAttribute("color", new BufferAttribute(new Float32Array(colors.flatMap((color) => color.toArray())), 3));
}
