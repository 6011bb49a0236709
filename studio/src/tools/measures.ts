// SPDX-License-Identifier: MIT
import { type Box3, BufferAttribute, BufferGeometry, LineBasicMaterial, LineSegments, Vector3 } from "three";
import { heightAt } from "../view/building_shapes";
import { inWall, type Wall, wallsOf } from "../document/walls";
import { nameOf } from "../document/scene_document";
import type { Parts } from "../parts";
import { formatLength } from "./lengths";

/** A distance that is shown is at most this, m. */
const FARTHEST = 20;
const LEAST = 0.005;
const COLOR = 0x3f8cff;
const DIRECTIONS = [new Vector3(1, 0, 0), new Vector3(-1, 0, 0), new Vector3(0, 0, 1), new Vector3(0, 0, -1)];

/** While things are dragged: their size, and how far they are from the walls around. */
export class Measures {
  private readonly lines = new LineSegments(new BufferGeometry(), new LineBasicMaterial({ color: COLOR, depthTest: false }));
  private readonly labels: HTMLElement[] = [];
  private isPressed = false;
  /** Boxes change while something is dragged; where none has, nothing is shown. */
  private last = "";

  constructor(private readonly parts: Pick<Parts, "document" | "playback" | "selection" | "entities" | "view">) {
    this.lines.renderOrder = 10;
    this.lines.frustumCulled = false;
    this.lines.visible = false;
    parts.view.scene.add(this.lines);
    const { canvas } = parts.view;
    canvas.addEventListener("pointerdown", (event) => {
      this.isPressed = event.button === 0;
      this.last = "";
    });
    for (const end of ["pointerup", "pointercancel"] as const) addEventListener(end, () => this.hide());
    parts.view.beforeFrame.on((now) => this.refresh(now));
  }

  private hide(): void {
    this.isPressed = false;
    if (!this.lines.visible) return;
    this.lines.visible = false;
    for (const label of this.labels) label.hidden = true;
    this.parts.view.invalidate();
  }

  private refresh(now: number): void {
    const { selection, playback, entities } = this.parts;
    if (!this.isPressed || playback.playing || selection.indices.length === 0) return;
    const bounds = entities.boundsOf(selection.indices, now);
    if (bounds.isEmpty()) return;
    const place = [...bounds.min.toArray(), ...bounds.max.toArray()].map((value) => value.toFixed(4)).join(" ");
    const isFirst = this.last === "";
    const has = place !== this.last;
    this.last = place;
    // A press alone moves nothing.
    if (isFirst || (!has && !this.lines.visible)) return;
    this.show(bounds);
  }

  private show(bounds: Box3): void {
    const centre = bounds.getCenter(new Vector3());
    const size = bounds.getSize(new Vector3());
    const walls = wallsOf(this.parts.document);
    const positions: number[] = [];
    const texts: { at: Vector3; text: string; kind: string }[] = [];
    for (const direction of DIRECTIONS) {
      const from = centre.clone().addScaledVector(direction, Math.abs(direction.dot(size)) / 2);
      from.y = Math.min(centre.y, bounds.min.y + 1);
      const distance = nearestWall(walls, from, direction);
      if (distance === null) continue;
      const to = from.clone().addScaledVector(direction, distance);
      positions.push(...from.toArray(), ...to.toArray());
      texts.push({ at: from.add(to).multiplyScalar(0.5), text: formatLength(distance), kind: "distance" });
    }
    const { indices } = this.parts.selection;
    const entity = indices.length === 1 ? this.parts.document.entity(indices[0]!) : undefined;
    const sizes = [size.x, size.z, size.y].map(formatLength).join(" × ");
    texts.push({ at: new Vector3(centre.x, bounds.max.y, centre.z), text: entity ? `${nameOf(entity)}: ${sizes}` : sizes, kind: "size" });
    this.lines.geometry.setAttribute("position", new BufferAttribute(new Float32Array(positions), 3));
    this.lines.visible = true;
    texts.forEach((text, k) => this.write(k, text));
    for (const label of this.labels.slice(texts.length)) label.hidden = true;
  }

  private write(which: number, { at, text, kind }: { at: Vector3; text: string; kind: string }): void {
    const label = (this.labels[which] ??= document.body.appendChild(document.createElement("div")));
    label.className = `measure-label ${kind}`;
    label.dataset["testid"] = `measure-${kind}`;
    label.textContent = text;
    const { x, y } = this.parts.view.project(at);
    label.style.left = `${x}px`;
    label.style.top = `${kind === "size" ? y - 34 : y - 10}px`;
    label.hidden = false;
  }
}

/** How far along a horizontal direction the face of the nearest wall is; null where there is none, or where it is touched. */
function nearestWall(walls: readonly Wall[], from: Vector3, direction: Vector3): number | null {
  let nearest: number | null = null;
  for (const wall of walls) {
    const start = inWall(wall, from);
    const way = inWall(wall, from.clone().add(direction)).sub(start);
    if (Math.abs(way.z) < 1e-6) continue;
    const distance = (-Math.sign(way.z) * (wall.shape.thickness / 2) - start.z) / way.z;
    const x = start.x + distance * way.x;
    const isOn = x > -wall.shape.thickness && x < wall.shape.length + wall.shape.thickness && start.y > -0.05 && start.y < heightAt(wall.shape, x);
    if (isOn && distance > LEAST && distance < FARTHEST && (nearest === null || distance < nearest)) nearest = distance;
  }
  return nearest;
}
