// SPDX-License-Identifier: MIT
import { BufferAttribute, BufferGeometry, Points, PointsMaterial } from "three";
import type { SoftBodies } from "./soft_bodies";

const COLOR = 0xffc24a;
/** Size on the page, in pixels. */
const SIZE = 9;

/** Dots over the pinned nodes of one entity. */
export class PinMarks {
  readonly points = new Points(new BufferGeometry(), new PointsMaterial({ color: COLOR, size: SIZE, sizeAttenuation: false, depthTest: false, transparent: true }));
  private index = 0;
  private nodes: readonly number[] = [];

  constructor(private readonly softs: SoftBodies) {
    this.points.frustumCulled = false;
    this.points.renderOrder = 995;
    this.points.raycast = () => {};
    this.show(0, []);
  }

  get count(): number {
    return this.points.visible ? this.nodes.length : 0;
  }

  /** Marks exactly these nodes of an entity. */
  show(index: number, nodes: readonly number[]): void {
    this.index = index;
    this.nodes = nodes;
    this.points.geometry.dispose();
    this.points.geometry = new BufferGeometry().setAttribute("position", new BufferAttribute(new Float32Array(3 * nodes.length), 3));
    this.points.visible = nodes.length > 0;
  }

  /** Moves the marks to the nodes' present positions. */
  update(): void {
    const places = this.softs.placesOf(this.index);
    this.points.visible = this.nodes.length > 0 && places !== null;
    if (!places || this.nodes.length === 0) return;
    const attribute = this.points.geometry.getAttribute("position") as BufferAttribute;
    this.nodes.forEach((node, at) => attribute.setXYZ(at, places[3 * node]!, places[3 * node + 1]!, places[3 * node + 2]!));
    attribute.needsUpdate = true;
  }
}
