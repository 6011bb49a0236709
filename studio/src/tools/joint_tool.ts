// SPDX-License-Identifier: MIT
import { Object3D, Quaternion, Vector3 } from "three";
import { TransformControls } from "three/examples/jsm/controls/TransformControls.js";
import type { Joint, Vector } from "../connection/scene_types";
import { positionOf, rotationOf } from "../document/scene_document";
import type { Parts } from "../parts";
import { Signal } from "../signal";
import { type JointMark, JointMarks } from "../view/joint_marks";
import type { Gizmo } from "./gizmo";
import { presentPoses } from "./poses";

const X = new Vector3(1, 0, 0);

export function hasAxis(joint: Pick<Joint, "type">): boolean {
  return joint.type === "hinge" || joint.type === "slider";
}

/** Shows joints in the picture, and lets the user pick an anchor there or turn the axis of the chosen one by handles. */
export class JointTool {
  /** Picking or turning has begun or ended. */
  readonly changed = new Signal<void>();
  picking = false;
  turning = false;
  private shown: readonly number[] = [];
  private chosen = 0;
  private readonly marks = new JointMarks();
  private readonly pivot = new Object3D();
  private readonly handles: TransformControls;

  constructor(
    private readonly parts: Pick<Parts, "server" | "document" | "selection" | "entities" | "view">,
    gizmo: Gizmo,
  ) {
    const { view } = parts;
    this.handles = new TransformControls(view.rig.camera, view.canvas);
    this.handles.setMode("rotate");
    this.handles.setSize(0.7);
    view.scene.add(this.marks.group, this.pivot, this.handles.getHelper());
    this.handles.addEventListener("change", () => view.invalidate());
    this.handles.addEventListener("dragging-changed", (event) => !event.value && this.turned());
    gizmo.others.add(() => this.isBusy);
    view.beforeFrame.on(() => this.draw());
    view.canvas.addEventListener("pointerdown", (event) => this.press(event), { capture: true });
    addEventListener("keydown", (event) => event.key === "Escape" && (this.pick(false), this.turn(false)));
    parts.document.changed.on(() => view.invalidate());
  }

  /** Draws these joints; 0: none of them is chosen. */
  show(joints: readonly number[], chosen: number): void {
    this.shown = joints;
    if (chosen !== this.chosen) {
      this.chosen = chosen;
      this.pick(false);
      this.turn(false);
    }
    this.parts.view.invalidate();
  }

  /** A handle is under the pointer or being dragged. */
  get isBusy(): boolean {
    return this.handles.dragging || (this.handles.axis !== null && this.turning);
  }

  /** How many joints are drawn. */
  get count(): number {
    return this.marks.group.visible ? this.shown.length : 0;
  }

  /** Where a joint is now, by the thing that it holds. */
  placeOf(joint: Joint): { anchor: Vector3; axis: Vector3 } | null {
    const entity = this.parts.document.entity(joint.entity_b);
    const drawn = presentPoses(this.parts, [joint.entity_b]).get(joint.entity_b);
    if (!entity) return null;
    const position = drawn?.position ?? new Vector3(...positionOf(entity.pose));
    const rotation = (drawn?.rotation ?? new Quaternion(...rotationOf(entity.pose))).normalize();
    const frame = new Quaternion(...rotationOf(joint.frame_b));
    return { anchor: new Vector3(...positionOf(joint.frame_b)).applyQuaternion(rotation).add(position), axis: X.clone().applyQuaternion(frame).applyQuaternion(rotation) };
  }

  /** The next click on the picture is the anchor of the chosen joint. */
  pick(picking: boolean): void {
    if (this.picking === picking) return;
    this.picking = picking;
    this.parts.view.canvas.style.cursor = picking ? "crosshair" : "";
    this.changed.emit();
  }

  /** Handles to turn the axis of the chosen joint. */
  turn(turning: boolean): void {
    if (this.turning === turning) return;
    this.turning = turning;
    const place = turning ? this.chosenPlace() : null;
    if (place) {
      this.pivot.position.copy(place.anchor);
      this.pivot.quaternion.setFromUnitVectors(X, place.axis);
      this.handles.attach(this.pivot);
    } else this.handles.detach();
    this.parts.view.invalidate();
    this.changed.emit();
  }

  private chosenPlace(): { anchor: Vector3; axis: Vector3 } | null {
    const joint = this.parts.document.joints.get(this.chosen);
    return joint ? this.placeOf(joint) : null;
  }

  private press(event: PointerEvent): void {
    if (!this.picking || event.button !== 0) return;
    event.stopImmediatePropagation();
    const hit = this.parts.view.pick(event.clientX, event.clientY);
    if (!hit) return;
    this.pick(false);
    void this.parts.server.command("joint.update", { index: this.chosen, joint: { anchor: hit.point.toArray() as Vector } });
  }

  private turned(): void {
    const axis = X.clone().applyQuaternion(this.pivot.quaternion);
    void this.parts.server.command("joint.update", { index: this.chosen, joint: { axis: axis.toArray() as Vector } });
  }

  private draw(): void {
    const { document, entities, view } = this.parts;
    const now = performance.now();
    const marks = this.shown.flatMap((index): JointMark[] => {
      const joint = document.joints.get(index);
      const place = joint && this.placeOf(joint);
      if (!joint || !place) return [];
      const ends = [joint.entity_a, joint.entity_b].flatMap((end) => {
        const bounds = end === undefined ? null : entities.boundsOf([end], now);
        return bounds && !bounds.isEmpty() ? [bounds.getCenter(new Vector3())] : [];
      });
      const chosen = index === this.chosen;
      const turned = chosen && this.turning ? X.clone().applyQuaternion(this.pivot.quaternion) : place.axis;
      if (chosen && this.turning && !this.handles.dragging) this.pivot.position.copy(place.anchor);
      return [{ anchor: place.anchor, axis: hasAxis(joint) ? turned : null, ends, chosen }];
    });
    this.marks.show(marks, view.rig.camera.position);
  }
}
