// SPDX-License-Identifier: MIT
import { Plane, Vector3 } from "three";
import { BodyState } from "../document/motion";
import type { Parts } from "../parts";
import type { Hit } from "../view/view";
import type { Gizmo, Tool } from "./gizmo";
import { isLocked, unlocked } from "./locks";
import { PoseDrag } from "./poses";
import { Pull } from "./pull";
import { SpringLine } from "./spring_line";
import { SurfaceDrag } from "./surface_drag";
import { turnByWheel } from "./arrange_actions";
import { withGroups } from "../document/groups";
import { Signal } from "../signal";

/** A press that moves less than this is a click, px. */
const CLICK_REACH = 4;

type Gesture =
  | { kind: "orbit" | "pan" | "look" }
  | { kind: "press"; hit: Hit | null }
  | { kind: "box"; frame: HTMLElement }
  | { kind: "grab"; plane: Plane; pull: Pull }
  | { kind: "carry"; drag: SurfaceDrag }
  | { kind: "slide"; plane: Plane; from: Vector3; drag: PoseDrag };

/** The mouse on the picture: selects, drags, pulls bodies while they move, and moves the camera. */
export class Pointer {
  /** The right button is down: letter keys move the camera instead of choosing tools. */
  flying = false;
  /** A click with the right button at a place of the page: what can be done there? */
  readonly menuWanted = new Signal<{ x: number; y: number }>();
  /** The user has taken hold of something that moves. */
  readonly grabbed = new Signal<void>();
  /** Where the pointer was last over the picture. */
  readonly last = { x: 0, y: 0, over: false };
  private gesture: Gesture | null = null;
  private startX = 0;
  private startY = 0;
  private lastX = 0;
  private lastY = 0;
  private moved = false;
  /** R is held. */
  private turning: { before: Tool; used: boolean } | null = null;
  private readonly held = new Set<string>();
  private readonly spring: SpringLine;

  constructor(
    private readonly parts: Pick<Parts, "preferences" | "server" | "notices" | "document" | "people" | "playback" | "selection" | "motion" | "entities" | "view">,
    private readonly gizmo: Gizmo,
  ) {
    this.spring = new SpringLine(parts);
    const canvas = parts.view.canvas;
    canvas.addEventListener("pointerdown", (event) => this.press(event));
    canvas.addEventListener("pointermove", (event) => this.move(event));
    canvas.addEventListener("pointerup", (event) => this.release(event));
    canvas.addEventListener("pointercancel", (event) => this.release(event));
    canvas.addEventListener("contextmenu", (event) => event.preventDefault());
    // On Linux a middle click pastes: moving the view would bring in what was copied.
    for (const kind of ["mouseup", "auxclick"] as const) canvas.addEventListener(kind, (event) => event.button === 1 && event.preventDefault());
    canvas.addEventListener("pointermove", (event) => Object.assign(this.last, { x: event.clientX, y: event.clientY, over: true }));
    canvas.addEventListener("pointerleave", () => (this.last.over = false));
    canvas.addEventListener("wheel", (event) => this.wheel(event), { passive: false });
    addEventListener("keydown", (event) => this.flightKey(event, true));
    addEventListener("keyup", (event) => this.flightKey(event, false));
    addEventListener("blur", () => this.stopFlight());
  }

  private press(event: PointerEvent): void {
    const { view } = this.parts;
    view.canvas.focus();
    if (this.gesture || (event.button === 0 && this.gizmo.busy)) return;
    view.canvas.setPointerCapture(event.pointerId);
    [this.startX, this.startY] = [this.lastX, this.lastY] = [event.clientX, event.clientY];
    this.moved = false;
    if (event.button === 1) this.gesture = { kind: "pan" };
    else if (event.button === 2) {
      this.gesture = { kind: "look" };
      this.flying = true;
    } else this.gesture = { kind: "press", hit: view.pick(event.clientX, event.clientY) };
  }

  private move(event: PointerEvent): void {
    const gesture = this.gesture;
    if (!gesture) return;
    const dx = event.clientX - this.lastX;
    const dy = event.clientY - this.lastY;
    if (Math.hypot(event.clientX - this.startX, event.clientY - this.startY) > CLICK_REACH) this.moved = true;
    if (gesture.kind === "press") {
      if (this.moved) this.beginDrag(gesture.hit, event);
      return;
    }
    [this.lastX, this.lastY] = [event.clientX, event.clientY];
    const { view } = this.parts;
    const turns = gesture.kind === "orbit" || gesture.kind === "look";
    if (gesture.kind === "orbit" && !view.rig.isPlan) view.rig.orbit(dx, dy);
    else if (gesture.kind === "pan" || (turns && view.rig.isPlan)) view.rig.pan(dx, dy, view.canvas.clientHeight);
    else if (gesture.kind === "look") view.rig.look(dx, dy);
    else if (gesture.kind === "grab") this.pull(gesture, event);
    else if (gesture.kind === "slide") this.slide(gesture, event);
    else if (gesture.kind === "carry") gesture.drag.moveTo(event.clientX, event.clientY, !event.shiftKey);
    else if (gesture.kind === "box") this.stretchBox(gesture.frame, event);
  }

  /** A press has become a drag; what is under it decides what it drags. */
  private beginDrag(hit: Hit | null, event: PointerEvent): void {
    const { parts } = this;
    const movable = hit !== null && this.isMovable(hit.index);
    if (event.ctrlKey || event.metaKey) this.gesture = { kind: "box", frame: this.makeBox() };
    else if (movable && parts.playback.playing && !event.shiftKey) this.beginGrab(hit);
    else if (movable && !parts.playback.playing && this.gizmo.tool === "move" && !event.shiftKey) this.beginSlide(hit);
    else if (hit !== null && !parts.playback.playing && this.gizmo.tool === "select" && !event.shiftKey && this.isLoose(hit.index)) this.beginCarry(hit);
    else this.gesture = { kind: event.shiftKey ? "pan" : "orbit" };
  }

  private isMovable(index: number): boolean {
    const { rights } = this.parts.people;
    if (isLocked(this.parts, index) || !(this.parts.playback.playing ? rights.run : rights.edit)) return false;
    const shape = this.parts.document.entity(index)?.shape?.type;
    if (shape === "plane" || shape === "heightfield" || shape === "mesh") return false;
    return !this.parts.playback.playing || this.parts.motion.state(index) !== BodyState.still;
  }

  /** Walls and floors stay: a drag on them turns the camera. What hangs on them is fixed, too, but is a thing of its own. */
  private isLoose(index: number): boolean {
    const entity = this.parts.document.entity(index);
    if (!entity || !this.isMovable(index) || ("locked" in entity && entity["locked"] === true)) return false;
    return this.parts.motion.state(index) !== BodyState.still || entity.model !== undefined || entity.attributes?.["placement"] !== undefined;
  }

  private beginCarry(hit: Hit): void {
    const { selection, document } = this.parts;
    if (!selection.has(hit.index)) selection.set(withGroups(document, [hit.index]));
    this.parts.view.canvas.classList.add("carrying");
    this.gesture = { kind: "carry", drag: new SurfaceDrag(this.parts, hit.index, selection.indices, this.startX, this.startY) };
  }

  private beginGrab(hit: Hit): void {
    const facing = this.parts.view.rig.camera.getWorldDirection(new Vector3()).negate();
    const plane = new Plane().setFromNormalAndCoplanarPoint(facing, hit.point);
    const pull = new Pull(this.parts, { index: hit.index, point: hit.point, hand: "mouse", strength: this.parts.preferences.get("pull") });
    this.gesture = { kind: "grab", plane, pull };
    this.spring.begin(hit.index, hit.point);
    this.grabbed.emit();
  }

  private pull({ plane, pull }: Extract<Gesture, { kind: "grab" }>, event: PointerEvent): void {
    const target = this.parts.view.meet(event.clientX, event.clientY, plane);
    if (!target) return;
    this.spring.pullTo(target);
    pull.target.copy(target);
    pull.follow();
  }

  /** Drags the entity under the pointer in the plane of the surface point that was pressed. */
  private beginSlide(hit: Hit): void {
    const { selection } = this.parts;
    if (!selection.has(hit.index)) selection.set([hit.index]);
    const plane = new Plane(new Vector3(0, 1, 0), -hit.point.y);
    this.gesture = { kind: "slide", plane, from: hit.point.clone(), drag: new PoseDrag(this.parts, unlocked(this.parts, selection.indices)) };
  }

  private slide(gesture: Extract<Gesture, { kind: "slide" }>, event: PointerEvent): void {
    const { view, preferences } = this.parts;
    const at = view.meet(event.clientX, event.clientY, gesture.plane);
    if (!at || at.distanceTo(view.rig.camera.position) > 20 * view.rig.distance) return;
    const shift = at.sub(gesture.from);
    if (preferences.get("snap") !== event.shiftKey) {
      const step = preferences.get("snapLength");
      shift.divideScalar(step).round().multiplyScalar(step);
    }
    for (const index of gesture.drag.start.keys())
      gesture.drag.hold(index, (pose, start) => pose.position.copy(start.position).add(shift));
    gesture.drag.send();
  }

  private release(event: PointerEvent): void {
    const gesture = this.gesture;
    this.gesture = null;
    if (gesture?.kind === "press") this.click(gesture.hit, event);
    else if (gesture?.kind === "box") this.chooseInBox(gesture.frame);
    else this.finish(gesture);
    if (gesture?.kind === "look" && !this.moved) this.openMenuAt(event.clientX, event.clientY);
  }

  private finish(gesture: Gesture | null): void {
    if (gesture?.kind === "grab") {
      this.spring.end();
      gesture.pull.release();
    } else if (gesture?.kind === "slide") void gesture.drag.end();
    else if (gesture?.kind === "box") gesture.frame.remove();
    else if (gesture?.kind === "carry") {
      this.parts.view.canvas.classList.remove("carrying");
      void gesture.drag.end();
    } else if (gesture?.kind === "look") this.stopFlight();
  }

  /** Ends what the pointer is doing, without a click; what it dragged stays where it is. */
  cancel(): void {
    const gesture = this.gesture;
    this.gesture = null;
    this.finish(gesture);
  }

  /** The menu is for what is under the pointer: that is selected first, unless it is already. */
  openMenuAt(x: number, y: number): void {
    const { view, selection, document } = this.parts;
    const hit = view.pick(x, y);
    if (!hit) selection.clear();
    else if (!selection.has(hit.index)) selection.set(withGroups(document, [hit.index]));
    this.menuWanted.emit({ x, y });
  }

  private click(hit: Hit | null, event: PointerEvent): void {
    const { selection, document } = this.parts;
    // With Alt the thing alone, not its group.
    const chosen = hit ? (event.altKey ? [hit.index] : withGroups(document, [hit.index])) : [];
    if (event.shiftKey || event.ctrlKey || event.metaKey) {
      if (hit && selection.has(hit.index)) selection.set(selection.indices.filter((index) => !chosen.includes(index)));
      else selection.set([...selection.indices, ...chosen]);
    } else selection.set(chosen);
  }

  private makeBox(): HTMLElement {
    const frame = document.createElement("div");
    frame.className = "selection-box";
    document.body.append(frame);
    return frame;
  }

  private stretchBox(frame: HTMLElement, event: PointerEvent): void {
    frame.style.left = `${Math.min(this.startX, event.clientX)}px`;
    frame.style.top = `${Math.min(this.startY, event.clientY)}px`;
    frame.style.width = `${Math.abs(event.clientX - this.startX)}px`;
    frame.style.height = `${Math.abs(event.clientY - this.startY)}px`;
  }

  /** Selects every entity that is not locked and whose centre lies in the rectangle, too. */
  private chooseInBox(frame: HTMLElement): void {
    const { view, entities, document, selection } = this.parts;
    const box = frame.getBoundingClientRect();
    frame.remove();
    const chosen = unlocked(this.parts, document.entities.keys()).filter((index) => {
      const bounds = entities.boundsOf([index], performance.now());
      if (bounds.isEmpty()) return false;
      const centre = bounds.getCenter(new Vector3());
      const depth = centre.clone().project(view.rig.camera).z;
      const at = view.project(centre);
      return depth < 1 && at.x >= box.left && at.x <= box.right && at.y >= box.top && at.y <= box.bottom;
    });
    selection.set(withGroups(document, [...selection.indices, ...chosen]));
  }

  private wheel(event: WheelEvent): void {
    event.preventDefault();
    // Wheels report lines or pixels; a notch is 3 lines or about 100 pixels.
    const notches = event.deltaMode === WheelEvent.DOM_DELTA_LINE ? event.deltaY / 3 : event.deltaY / 100;
    // Some systems turn a wheel with Alt or Shift into a sideways one.
    const turns = event.altKey || this.turning !== null;
    if (this.turning) this.turning.used = true;
    if (turns && this.parts.selection.indices.length > 0) return turnByWheel(this.parts, notches || Math.sign(event.deltaX));
    this.parts.view.rig.zoom(Math.min(Math.max(notches, -3), 3));
  }

  /** With R held the wheel turns the selection. R alone is the scale tool, so that the tool of before comes back. */
  private turningKey(event: KeyboardEvent, down: boolean): void {
    if (event.code !== "KeyR" || event.repeat) return;
    if (!down && this.turning?.used) this.gizmo.use(this.turning.before);
    this.turning = down && !event.ctrlKey && !event.metaKey ? { before: this.gizmo.tool, used: false } : null;
  }

  private flightKey(event: KeyboardEvent, down: boolean): void {
    this.turningKey(event, down);
    if (!this.flying) return;
    if (down) this.held.add(event.code);
    else this.held.delete(event.code);
    const along = (plus: string, minus: string) => Number(this.held.has(plus)) - Number(this.held.has(minus));
    this.parts.view.rig.fly(along("KeyD", "KeyA"), along("KeyE", "KeyQ"), along("KeyS", "KeyW"));
  }

  private stopFlight(): void {
    this.turning = null;
    this.flying = false;
    this.held.clear();
    this.parts.view.rig.fly(0, 0, 0);
  }
}
