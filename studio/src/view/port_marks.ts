// SPDX-License-Identifier: MIT
import { BufferAttribute, BufferGeometry, LineBasicMaterial, LineSegments, Matrix4, Vector3 } from "three";
import { drainOf, tapOf } from "../document/ports";
import type { SceneDocument } from "../document/scene_document";
import type { EntityView } from "./entity_view";

const COLOR = 0x35c6e8;
const SHUT = 0x8fa3b3;
/** Corners of a circle, and the shortest arrow, m. */
const CORNERS = 24;
const ARROW = 0.08;

/** Lines over the picture at the selected taps and drains: the mouth with an arrow along the flow, the ball of a drain. */
export class PortMarks {
  readonly lines = new LineSegments(new BufferGeometry(), new LineBasicMaterial({ depthTest: false, transparent: true }));
  private indices: readonly number[] = [];
  private readonly matrix = new Matrix4();

  constructor(
    private readonly document: SceneDocument,
    private readonly entities: EntityView,
  ) {
    this.lines.frustumCulled = false;
    this.lines.renderOrder = 994;
    this.lines.raycast = () => {};
    this.lines.material.toneMapped = false;
    this.lines.visible = false;
  }

  /** Number of lines that are drawn. */
  get count(): number {
    return this.lines.visible ? this.lines.geometry.getAttribute("position").count / 2 : 0;
  }

  show(indices: readonly number[]): void {
    this.indices = indices;
  }

  /** Draws them where the entities are now. */
  update(now: number): void {
    const places: Vector3[] = [];
    let isOpen = false;
    for (const index of this.indices) {
      const entity = this.document.entity(index);
      if (!entity) continue;
      const tap = tapOf(entity);
      const drain = drainOf(entity);
      const found = tap.litres_per_minute > 0 || drain.radius > 0;
      if (!found || !this.entities.matrixOf(index, now, this.matrix)) continue;
      const from = places.length;
      if (tap.litres_per_minute > 0) addTap(places, new Vector3(...tap.position), tap.radius);
      if (drain.radius > 0) for (const axis of [0, 1, 2]) addCircle(places, new Vector3(...drain.position), drain.radius, axis);
      for (const place of places.slice(from)) place.applyMatrix4(this.matrix);
      isOpen ||= (tap.litres_per_minute > 0 && tap.open) || (drain.radius > 0 && drain.open);
    }
    // Most pictures have none: they make no buffers.
    if (places.length === 0 && !this.lines.visible) return;
    this.lines.visible = places.length > 0;
    this.lines.material.color.set(isOpen ? COLOR : SHUT);
    this.lines.geometry.setAttribute("position", new BufferAttribute(new Float32Array(places.flatMap((place) => place.toArray())), 3));
  }
}

/** A circle across an axis of the frame. */
function addCircle(places: Vector3[], center: Vector3, radius: number, axis: number): void {
  const at = (corner: number) => {
    const angle = (2 * Math.PI * corner) / CORNERS;
    const parts = [0, 0, 0];
    parts[(axis + 1) % 3] = radius * Math.cos(angle);
    parts[(axis + 2) % 3] = radius * Math.sin(angle);
    return center.clone().add(new Vector3(...parts));
  };
  for (let corner = 0; corner < CORNERS; corner++) places.push(at(corner), at(corner + 1));
}

function addTap(places: Vector3[], mouth: Vector3, radius: number): void {
  addCircle(places, mouth, radius, 1);
  const length = Math.max(ARROW, 4 * radius);
  const tip = mouth.clone().add(new Vector3(0, -length, 0));
  const barb = length / 5;
  places.push(mouth, tip);
  for (const [x, z] of [[barb, 0], [-barb, 0], [0, barb], [0, -barb]]) places.push(tip, tip.clone().add(new Vector3(x, barb, z)));
}
