// SPDX-License-Identifier: MIT
import { Matrix4, Object3D, Vector3 } from "three";
import { TransformControls } from "three/examples/jsm/controls/TransformControls.js";
import type { Shape, Vector } from "../connection/scene_types";
import { Signal } from "../signal";
import type { Parts } from "../parts";
import { isOfLengths, scaledLengths } from "../view/shapes_of_lengths";
import { unlocked } from "./locks";
import { PoseDrag } from "./poses";

export type Tool = "select" | "move" | "rotate" | "scale";

const ONE = new Vector3(1, 1, 1);

/** The handles of the move, rotate and scale tools; they act on all of the selection that is not locked, about the last entity of it. */
export class Gizmo {
  readonly changed = new Signal<void>();
  tool: Tool = "select";
  space: "world" | "local" = "world";
  /** Whether other handles in the picture have the pointer. */
  readonly others = new Set<() => boolean>();
  private readonly pivot = new Object3D();
  private readonly controls: TransformControls;
  private drag: PoseDrag | null = null;
  private readonly before = new Matrix4();
  private readonly delta = new Matrix4();
  private readonly matrix = new Matrix4();
  private readonly size = new Vector3();
  /** Shift is held, which reverses snapping. */
  private turned = false;

  constructor(private readonly parts: Pick<Parts, "preferences" | "server" | "document" | "people" | "selection" | "motion" | "entities" | "view">) {
    const { view } = parts;
    this.controls = new TransformControls(view.rig.camera, view.canvas);
    this.controls.setSize(0.8);
    view.scene.add(this.pivot, this.controls.getHelper());
    this.controls.addEventListener("change", () => view.invalidate());
    this.controls.addEventListener("dragging-changed", (event) => (event.value ? this.begin() : this.end()));
    this.controls.addEventListener("objectChange", () => this.follow());
    view.beforeFrame.on((now) => this.place(now));
    parts.selection.changed.on(() => this.attach());
    parts.entities.loaded.on(() => this.attach());
    parts.document.changed.on(() => this.attach());
    parts.people.changed.on(() => this.attach());
    parts.preferences.changed.on(() => this.applySnap());
    for (const kind of ["keydown", "keyup"] as const)
      addEventListener(kind, (event) => {
        if (event.key !== "Shift") return;
        this.turned = kind === "keydown";
        this.applySnap();
      });
    this.applySnap();
  }

  /** A handle is under the pointer or being dragged: the click belongs to the gizmo. */
  get busy(): boolean {
    return this.controls.dragging || (this.controls.axis !== null && this.controls.object !== undefined) || [...this.others].some((isBusy) => isBusy());
  }

  use(tool: Tool): void {
    this.tool = tool;
    this.attach();
    this.changed.emit();
  }

  /** The handles are for the mouse: in a headset they are taken away. */
  show(shown: boolean): void {
    if (shown) this.parts.view.scene.add(this.controls.getHelper());
    else this.parts.view.scene.remove(this.controls.getHelper());
  }

  setSpace(space: "world" | "local"): void {
    this.space = space;
    this.controls.setSpace(space);
    this.changed.emit();
    this.parts.view.invalidate();
  }

  private movable(): number[] {
    return unlocked(this.parts, this.parts.selection.indices);
  }

  private attach(): void {
    const drawn = this.movable().some((index) => this.parts.entities.drawableOf(index));
    if (this.controls.dragging) return;
    if (this.tool === "select" || !drawn || !this.parts.people.rights.edit) {
      this.controls.detach();
    } else {
      this.place(performance.now());
      this.controls.setMode(this.tool === "move" ? "translate" : this.tool);
      // A model can only be scaled uniformly.
      const uniform = this.tool === "scale";
      this.controls.showX = this.controls.showY = this.controls.showZ = !uniform;
      this.controls.attach(this.pivot);
    }
    this.parts.view.invalidate();
  }

  /** Keeps the handles at the last selected entity while it moves. */
  private place(now: number): void {
    const last = this.movable().at(-1);
    if (last === undefined || this.controls.dragging) return;
    if (!this.parts.entities.matrixOf(last, now, this.matrix)) return;
    this.matrix.decompose(this.pivot.position, this.pivot.quaternion, this.size);
    this.pivot.scale.copy(ONE);
    this.pivot.updateMatrixWorld();
  }

  private begin(): void {
    this.drag = new PoseDrag(this.parts, this.movable());
    this.before.compose(this.pivot.position, this.pivot.quaternion, ONE).invert();
  }

  private follow(): void {
    const drag = this.drag;
    if (!drag) return;
    const factor = this.tool === "scale" ? Math.max(this.pivot.scale.x, 0.01) : 1;
    this.delta.compose(this.pivot.position, this.pivot.quaternion, ONE).multiply(this.before);
    for (const index of drag.start.keys())
      drag.hold(index, (pose, start) => {
        this.matrix.compose(start.position, start.rotation, ONE).premultiply(this.delta);
        this.matrix.decompose(pose.position, pose.rotation, this.size);
        pose.scale = start.scale * factor;
      });
    // A scale changes the entity itself and is sent once, when the drag ends.
    if (this.tool !== "scale") drag.send();
  }

  private end(): void {
    const drag = this.drag;
    this.drag = null;
    if (!drag) return;
    if (this.tool === "scale") void scaleEntities(this.parts, drag, this.pivot.scale.x);
    else void drag.end();
  }

  private applySnap(): void {
    const { preferences } = this.parts;
    const snap = preferences.get("snap") !== this.turned;
    this.controls.setTranslationSnap(snap ? preferences.get("snapLength") : null);
    this.controls.setRotationSnap(snap ? (preferences.get("snapAngle") * Math.PI) / 180 : null);
    this.controls.setScaleSnap(snap ? 0.1 : null);
  }
}

/** Makes what is dragged larger by a factor, in the drag's own step of undo, and ends the drag. */
export async function scaleEntities(parts: Pick<Parts, "server" | "document">, drag: PoseDrag, factor: number): Promise<void> {
  for (const index of drag.start.keys()) {
    const entity = parts.document.entity(index);
    const shape = entity?.shape && scaledShape(entity.shape, factor);
    const changed = entity?.model ? { scale: (entity.scale ?? 1) * factor } : shape && { shape };
    if (changed) await parts.server.command("entity.update", { index, entity: changed, merge: drag.merge });
  }
  await drag.end();
}

/** A primitive of another size; undefined for what cannot be scaled, such as planes. */
export function scaledShape(shape: Shape, factor: number): Shape | undefined {
  if (isOfLengths(shape)) return scaledLengths(shape, factor);
  if (shape.type !== "hull") return undefined;
  return { ...shape, points: shape.points.map((point) => point.map((number) => number * factor) as Vector) };
}
