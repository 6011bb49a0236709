// SPDX-License-Identifier: MIT
import { Box3, BufferAttribute, BufferGeometry, LineBasicMaterial, LineSegments, Matrix4, Vector3 } from "three";
import { drainOf, tapOf } from "../document/ports";
import type { SceneDocument } from "../document/scene_document";
import type { EntityView } from "./entity_view";

const COLOR = 0x35c6e8;
const SHUT = 0x8fa3b3;
/** Corners of a circle, and the shortest arrow, m. */
const CORNERS = 24;
const ARROW = 0.08;

/** Lines over the picture at what is selected: the mouth of a tap with an arrow along the flow, the ball of a drain, the box that a liquid without a drop is to fill. */
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

  /** The box around them, m, world. */
  get bounds(): Box3 {
    const bounds = new Box3();
    return this.count > 0 ? bounds.setFromBufferAttribute(this.lines.geometry.getAttribute("position") as BufferAttribute) : bounds;
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
      const isEmpty = this.entities.isEmpty(index);
      const found = tap.litres_per_minute > 0 || drain.radius > 0 || isEmpty;
      if (!found || !this.entities.matrixOf(index, now, this.matrix)) continue;
      const from = places.length;
      if (tap.litres_per_minute > 0) addTap(places, new Vector3(...tap.position), tap.radius);
      if (drain.radius > 0) for (const axis of [0, 1, 2]) addCircle(places, new Vector3(...drain.position), drain.radius, axis);
      const shape = isEmpty ? this.entities.drawableOf(index) : undefined;
      if (shape) addBox(places, shape.bounds);
      // Copies, since ends of several lines may be one object.
      for (let at = from; at < places.length; at++) places[at] = places[at]!.clone().applyMatrix4(this.matrix);
      isOpen ||= isEmpty || (tap.litres_per_minute > 0 && tap.open) || (drain.radius > 0 && drain.open);
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

/** The edges of a box. */
function addBox(places: Vector3[], { min, max }: Box3): void {
  const corner = (at: number) => new Vector3(at & 1 ? max.x : min.x, at & 2 ? max.y : min.y, at & 4 ? max.z : min.z);
  for (let from = 0; from < 8; from++) for (const step of [1, 2, 4]) if (!(from & step)) places.push(corner(from), corner(from | step));
}

function addTap(places: Vector3[], mouth: Vector3, radius: number): void {
  addCircle(places, mouth, radius, 1);
  const length = Math.max(ARROW, 4 * radius);
  const tip = mouth.clone().add(new Vector3(0, -length, 0));
  const barb = length / 5;
  places.push(mouth, tip);
  for (const [x, z] of [[barb, 0], [-barb, 0], [0, barb], [0, -barb]]) places.push(tip, tip.clone().add(new Vector3(x, barb, z)));
}
