// SPDX-License-Identifier: MIT
import { Box3, BufferAttribute, BufferGeometry, Group, LineBasicMaterial, LineSegments, type Vector3 } from "three";

/** Corners of the twelve edges of a box; bits of a corner are its high axes. */
const EDGES = [0, 1, 2, 3, 4, 5, 6, 7].flatMap((corner) => [1, 2, 4].flatMap((axis) => (corner & axis ? [] : [corner, corner | axis])));

/** Outlines of boxes over the picture: where things would come to be. */
export class BoxPreview {
  readonly group = new Group();
  private readonly lines = new LineSegments(new BufferGeometry(), new LineBasicMaterial({ color: 0xffc24a, depthTest: false, transparent: true, opacity: 0.9 }));
  /** How many boxes are drawn. */
  count = 0;

  constructor() {
    this.lines.frustumCulled = false;
    this.lines.renderOrder = 993;
    this.lines.raycast = () => {};
    this.lines.material.toneMapped = false;
    this.group.add(this.lines);
  }

  /** Draws the box at each of these offsets; none: nothing. */
  show(box: Box3, offsets: readonly Vector3[]): void {
    const places = new Float32Array(offsets.length * EDGES.length * 3);
    let at = 0;
    for (const offset of offsets)
      for (const corner of EDGES)
        for (const axis of [0, 1, 2]) {
          const side = corner & (1 << axis) ? box.max : box.min;
          places[at++] = side.getComponent(axis) + offset.getComponent(axis);
        }
    this.lines.geometry.dispose();
    this.lines.geometry = new BufferGeometry().setAttribute("position", new BufferAttribute(places, 3));
    this.group.visible = offsets.length > 0;
    this.count = offsets.length;
  }
}
