// SPDX-License-Identifier: MIT
import { BoxGeometry, Group, Mesh, MeshBasicMaterial, Plane, Vector3 } from "three";
import type { Vector, WallOpening } from "../connection/scene_types";
import { inWall, movedOpening, type Wall, wallOf, wallsOf } from "../document/walls";
import type { Parts } from "../parts";
import { Signal } from "../signal";
import { formatLength } from "./lengths";
import { t } from "../language";

export type BuildMode = "wall" | "room" | "door" | "window" | "hole";

/** What is cut into a wall by a click, m. */
const OPENINGS: Record<"door" | "window" | "hole", Omit<WallOpening, "offset">> = {
  door: { kind: "door", width: 0.9, height: 2.1, sill: 0 },
  window: { kind: "window", width: 1.2, height: 1.2, sill: 0.9 },
  hole: { kind: "hole", width: 1.2, height: 2.2, sill: 0 },
};
/** Ends of walls nearer to the pointer than this are met, px; m of the grid; degrees of the angles that lines snap to, and from how near. */
const END_REACH = 14;
const GRID = 0.1;
const ANGLE_STEP = 15;
const ANGLE_REACH = 5;
const THINNEST = 0.02;
const FLOOR_RISE = 0.005;
const FLOOR_THICKNESS = 0.15;
const FLOOR_COLOR: Vector = [0.35, 0.24, 0.15];
const PREVIEW_COLOR = 0x3f8cff;

/** Builds by clicks: walls from point to point, rooms by a drag, doors and windows into walls. The server makes what is built. */
export class BuildTool {
  readonly changed = new Signal<void>();
  mode: BuildMode | null = null;
  height = 2.5;
  thickness = 0.12;
  /** Of the floor that is built on, m. */
  base = 0;
  private readonly corners: Vector3[] = [];
  private pressed: Vector3 | null = null;
  private at: Vector3 | null = null;
  /** What was typed for the length. */
  private typed = "";
  private dragged: { wall: Wall; which: number; grip: Vector3; merge: string; wanted: WallOpening | null; sending: boolean } | null = null;
  private static drags = 0;
  private readonly preview = new Group();
  private readonly material = new MeshBasicMaterial({ color: PREVIEW_COLOR, transparent: true, opacity: 0.45, depthWrite: false });
  private readonly box = new BoxGeometry(1, 1, 1);
  private readonly label = document.createElement("div");

  constructor(private readonly parts: Pick<Parts, "server" | "document" | "playback" | "selection" | "view" | "notices">) {
    const { canvas } = parts.view;
    this.label.className = "measure-label";
    this.label.dataset["testid"] = "build-length";
    this.label.hidden = true;
    document.body.append(this.label);
    this.preview.name = "build preview";
    parts.view.scene.add(this.preview);
    // Before the pointer's own listeners: while something is built, the left button is ours.
    canvas.addEventListener("pointerdown", (event) => this.press(event), { capture: true });
    canvas.addEventListener("pointermove", (event) => this.move(event), { capture: true });
    canvas.addEventListener("pointerup", (event) => this.release(event), { capture: true });
    canvas.addEventListener("pointerleave", () => this.hide());
    addEventListener("keydown", (event) => this.key(event), { capture: true });
    parts.playback.changed.on(() => parts.playback.playing && this.choose(null));
  }

  choose(mode: BuildMode | null): void {
    if (mode !== null && this.parts.playback.playing) {
      this.parts.notices.tell({ level: "info", text: t("Stop the simulation to build.") });
      mode = null;
    }
    this.end();
    this.mode = mode;
    this.parts.view.canvas.classList.toggle("building", mode !== null);
    if (mode) this.parts.selection.clear();
    this.changed.emit();
  }

  /** Ends the row of walls that is being drawn. */
  private end(): void {
    this.corners.length = 0;
    this.pressed = null;
    this.typed = "";
    this.hide();
  }

  private hide(): void {
    this.preview.clear();
    this.label.hidden = true;
    this.at = null;
    this.parts.view.invalidate();
  }

  private press(event: PointerEvent): void {
    if (event.button !== 0 || event.ctrlKey || event.metaKey) return;
    if (this.mode === null) return void this.pressOpening(event);
    event.stopImmediatePropagation();
    this.parts.view.canvas.focus();
    if (this.mode === "room") {
      this.pressed = this.pointOf(event);
      this.parts.view.canvas.setPointerCapture(event.pointerId);
    }
  }

  private move(event: PointerEvent): void {
    if (this.dragged) {
      event.stopImmediatePropagation();
      this.dragOpening(event);
    }
    if (this.mode === null || event.buttons > 1) return;
    if (this.mode === "wall" || this.mode === "room") {
      this.at = this.pointOf(event);
      this.show(event.clientX, event.clientY);
    }
  }

  private release(event: PointerEvent): void {
    if (event.button !== 0) return;
    if (this.dragged) {
      event.stopImmediatePropagation();
      this.dragged = null;
      this.label.hidden = true;
      return;
    }
    if (this.mode === null) return;
    event.stopImmediatePropagation();
    if (this.mode === "wall") this.addCorner(this.pointOf(event));
    else if (this.mode === "room") this.addRoom(this.pointOf(event));
    else this.cut(event, OPENINGS[this.mode]);
  }

  private key(event: KeyboardEvent): void {
    if (this.mode === null || event.target instanceof HTMLInputElement || event.ctrlKey || event.metaKey) return;
    const isDrawing = this.corners.length > 0;
    if (event.key === "Escape") {
      if (isDrawing || this.pressed) this.end();
      else this.choose(null);
    } else if (this.mode === "wall" && isDrawing && /^[0-9.,]$/.test(event.key)) this.typed += event.key.replace(",", ".");
    else if (isDrawing && event.key === "Backspace" && this.typed) this.typed = this.typed.slice(0, -1);
    else if (event.key === "Enter" && isDrawing) {
      if (this.typed && this.at) this.addCorner(this.at);
      else this.end();
    } else return;
    event.preventDefault();
    event.stopImmediatePropagation();
    if (this.at) this.show();
  }

  // Points ---------------------------------------------------------------------------------------------------------------

  /** The point of the floor under the pointer, snapped to ends of walls, angles and the grid; with Shift as it is. */
  private pointOf(event: PointerEvent): Vector3 | null {
    const { view } = this.parts;
    const point = view.meet(event.clientX, event.clientY, new Plane(new Vector3(0, 1, 0), -this.base));
    if (!point || point.distanceTo(view.rig.camera.position) > 20 * view.rig.distance) return null;
    point.y = this.base;
    if (event.shiftKey) return point;
    const end = this.nearestEnd(event);
    if (end) return end;
    const from = this.corners.at(-1);
    if (!from) return new Vector3(Math.round(point.x / GRID) * GRID, this.base, Math.round(point.z / GRID) * GRID);
    const way = point.clone().sub(from);
    const angle = (Math.atan2(way.z, way.x) * 180) / Math.PI;
    const straight = Math.round(angle / ANGLE_STEP) * ANGLE_STEP;
    const turned = ((Math.abs(angle - straight) < ANGLE_REACH ? straight : angle) * Math.PI) / 180;
    const length = Math.max(Math.round(way.length() / GRID) * GRID, GRID);
    return new Vector3(from.x + length * Math.cos(turned), this.base, from.z + length * Math.sin(turned));
  }

  private nearestEnd(event: PointerEvent): Vector3 | null {
    const ends = [...this.corners.slice(0, -1), ...wallsOf(this.parts.document).flatMap(({ start, end }) => [start, end])].filter(({ y }) => Math.abs(y - this.base) < 0.01);
    let nearest: Vector3 | null = null;
    let least = END_REACH;
    for (const end of ends) {
      const { x, y } = this.parts.view.project(end);
      const distance = Math.hypot(x - event.clientX, y - event.clientY);
      if (distance < least) [nearest, least] = [end, distance];
    }
    return nearest?.clone() ?? null;
  }

  /** The point with the length that was typed, where one was. */
  private typedPoint(from: Vector3, to: Vector3): Vector3 {
    const length = Number.parseFloat(this.typed);
    if (!(length > 0)) return to;
    return to.clone().sub(from).normalize().multiplyScalar(length).add(from);
  }

  // Building -------------------------------------------------------------------------------------------------------------

  private addCorner(point: Vector3 | null): void {
    if (!point) return;
    const from = this.corners.at(-1);
    const to = from ? this.typedPoint(from, point) : point;
    this.typed = "";
    if (from && from.distanceTo(to) < THINNEST) return this.end();
    this.corners.push(to);
    if (from) void this.parts.server.command("room.add", { points: [toList(from), toList(to)], height: this.height, thickness: this.thickness });
    // Back at the first corner: a room.
    if (this.corners.length > 3 && to.distanceTo(this.corners[0]!) < THINNEST) {
      void this.addFloor(this.corners.slice(0, -1));
      this.end();
    }
  }

  private async addFloor(corners: readonly Vector3[]): Promise<void> {
    const first = corners[0]!;
    const points = corners.map(({ x, z }) => [x - first.x, z - first.z] as [number, number]);
    await this.parts.server.command("entity.add", {
      entity: {
        name: t("Room floor"),
        category: "floor",
        shape: { type: "slab", thickness: FLOOR_THICKNESS, points },
        attributes: { kind: "static" },
        pose: { position: [first.x, first.y + FLOOR_RISE, first.z] },
        color: FLOOR_COLOR,
        locked: true,
      },
    });
  }

  private addRoom(to: Vector3 | null): void {
    const from = this.pressed;
    this.end();
    if (!from || !to || Math.abs(from.x - to.x) < GRID || Math.abs(from.z - to.z) < GRID) return;
    const [x, X] = [Math.min(from.x, to.x), Math.max(from.x, to.x)];
    const [z, Z] = [Math.min(from.z, to.z), Math.max(from.z, to.z)];
    const points: Vector[] = [[x, this.base, z], [X, this.base, z], [X, this.base, Z], [x, this.base, Z]];
    void this.parts.server.command("room.add", { points, closed: true, floor: true, height: this.height, thickness: this.thickness });
  }

  private cut(event: PointerEvent, opening: Omit<WallOpening, "offset">): void {
    const { view, document, notices, server } = this.parts;
    const hit = view.pick(event.clientX, event.clientY);
    const entity = hit && document.entity(hit.index);
    const wall = entity && wallOf(entity);
    if (!hit || !wall) return notices.tell({ level: "info", text: t("Click on a wall.") });
    const at = inWall(wall, hit.point);
    const isLow = opening.kind !== "window";
    const made = movedOpening(wall.shape, { ...opening, offset: 0 }, at.x - opening.width / 2, isLow ? 0 : opening.sill);
    void server.command("entity.update", { index: wall.index, entity: { shape: { ...wall.shape, openings: [...(wall.shape.openings ?? []), made] } } });
    this.parts.selection.set([wall.index]);
  }

  // Openings of the selected wall are dragged along it ---------------------------------------------------------------------

  private pressOpening(event: PointerEvent): void {
    const { selection, document, playback, view } = this.parts;
    if (playback.playing || selection.indices.length !== 1) return;
    const entity = document.entities.get(selection.indices[0]!);
    const wall = entity && wallOf(entity);
    const point = wall && this.onMiddle(wall, event);
    if (!wall || !point) return;
    const which = (wall.shape.openings ?? []).findIndex(
      (each) => !each.entity && point.x > each.offset && point.x < each.offset + each.width && point.y > (each.sill ?? 0) && point.y < (each.sill ?? 0) + each.height,
    );
    if (which < 0) return;
    event.stopImmediatePropagation();
    view.canvas.setPointerCapture(event.pointerId);
    const { offset, sill = 0 } = wall.shape.openings![which]!;
    this.dragged = { wall, which, grip: new Vector3(point.x - offset, point.y - sill, 0), merge: `opening-${Date.now()}-${BuildTool.drags++}`, wanted: null, sending: false };
  }

  private onMiddle(wall: Wall, event: PointerEvent): Vector3 | null {
    const normal = new Vector3(0, 0, 1).applyQuaternion(wall.rotation);
    const met = this.parts.view.meet(event.clientX, event.clientY, new Plane().setFromNormalAndCoplanarPoint(normal, wall.position));
    return met && inWall(wall, met);
  }

  private dragOpening(event: PointerEvent): void {
    const drag = this.dragged!;
    const point = this.onMiddle(drag.wall, event);
    if (!point) return;
    const opening = drag.wall.shape.openings![drag.which]!;
    const round = (value: number) => (event.shiftKey ? value : Math.round(value / 0.05) * 0.05);
    const sill = opening.kind === "window" ? round(point.y - drag.grip.y) : (opening.sill ?? 0);
    const moved = movedOpening(drag.wall.shape, opening, round(point.x - drag.grip.x), sill);
    drag.wanted = moved;
    const after = drag.wall.shape.length - moved.offset - moved.width;
    this.tell(`${formatLength(moved.offset)} | ${formatLength(moved.width)} | ${formatLength(after)}`, event.clientX, event.clientY);
    if (!drag.sending) void this.sendOpening(drag);
  }

  private async sendOpening(drag: NonNullable<BuildTool["dragged"]>): Promise<void> {
    drag.sending = true;
    while (drag.wanted) {
      const wanted = drag.wanted;
      drag.wanted = null;
      const entity = this.parts.document.entities.get(drag.wall.index);
      const wall = entity && wallOf(entity);
      if (!wall) break;
      const openings = (wall.shape.openings ?? []).map((each, k) => (k === drag.which ? wanted : each));
      if (!(await this.parts.server.command("entity.update", { index: wall.index, entity: { shape: { ...wall.shape, openings } }, merge: drag.merge }))) break;
    }
    drag.sending = false;
  }

  // What is shown --------------------------------------------------------------------------------------------------------

  private show(x?: number, y?: number): void {
    this.preview.clear();
    const { at } = this;
    if (!at) return this.hide();
    if (this.mode === "room" && this.pressed) {
      const [a, b] = [this.pressed, at];
      const corners = [a, new Vector3(b.x, a.y, a.z), b, new Vector3(a.x, a.y, b.z)];
      corners.forEach((corner, k) => this.showWall(corner, corners[(k + 1) % 4]!));
      this.tell(`${formatLength(Math.abs(b.x - a.x))} × ${formatLength(Math.abs(b.z - a.z))}`, x, y);
    } else {
      const from = this.corners.at(-1);
      const to = from ? this.typedPoint(from, at) : at;
      if (from) this.showWall(from, to);
      else this.showWall(to.clone().add(new Vector3(-this.thickness / 2, 0, 0)), to.clone().add(new Vector3(this.thickness / 2, 0, 0)));
      if (from) this.tell(this.typed ? `${this.typed} m` : `${formatLength(from.distanceTo(to))}, ${angleOf(from, to)}°`, x, y);
      else this.label.hidden = true;
    }
    this.parts.view.invalidate();
  }

  private showWall(from: Vector3, to: Vector3): void {
    const length = from.distanceTo(to);
    if (length < 1e-6) return;
    const mesh = new Mesh(this.box, this.material);
    mesh.scale.set(length, this.height, this.thickness);
    mesh.position.addVectors(from, to).multiplyScalar(0.5).setY(this.base + this.height / 2);
    mesh.rotation.y = Math.atan2(-(to.z - from.z), to.x - from.x);
    this.preview.add(mesh);
  }

  private tell(text: string, x?: number, y?: number): void {
    this.label.textContent = text;
    this.label.hidden = false;
    if (x === undefined || y === undefined) return;
    this.label.style.left = `${x + 16}px`;
    this.label.style.top = `${y + 16}px`;
  }
}

function toList({ x, y, z }: Vector3): Vector {
  return [x, y, z];
}

/** Counter-clockwise as seen from above, 0 … 359. */
function angleOf(from: Vector3, to: Vector3): number {
  const degrees = (Math.atan2(-(to.z - from.z), to.x - from.x) * 180) / Math.PI;
  return (Math.round(degrees) + 360) % 360;
}
