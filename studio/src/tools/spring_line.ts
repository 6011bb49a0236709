// SPDX-License-Identifier: MIT
import { BufferGeometry, Line, LineBasicMaterial, Matrix4, Vector3 } from "three";
import type { Parts } from "../parts";

/** The spring between a body that is pulled and the pointer, drawn as a line over everything. */
export class SpringLine {
  private readonly ends = [new Vector3(), new Vector3()];
  private readonly line = new Line(new BufferGeometry().setFromPoints(this.ends), new LineBasicMaterial({ color: 0xff9d2e, depthTest: false, transparent: true }));
  /** The point of the body that the spring pulls at, in the body's frame. */
  private readonly hook = new Vector3();
  private readonly matrix = new Matrix4();
  private index: number | null = null;

  constructor(private readonly parts: Pick<Parts, "entities" | "view">) {
    this.line.visible = false;
    this.line.frustumCulled = false;
    this.line.renderOrder = 2;
    this.line.raycast = () => {};
    parts.view.scene.add(this.line);
    parts.view.beforeFrame.on((now) => this.follow(now));
  }

  /** Attaches the spring to body `index` at a point of the world. */
  begin(index: number, point: Vector3): void {
    if (!this.parts.entities.matrixOf(index, performance.now(), this.matrix)) return;
    this.index = index;
    this.hook.copy(point).applyMatrix4(this.matrix.invert());
    this.pullTo(point);
  }

  pullTo(target: Vector3): void {
    this.ends[1]!.copy(target);
    this.parts.view.invalidate();
  }

  end(): void {
    this.index = null;
    this.line.visible = false;
    this.parts.view.invalidate();
  }

  private follow(now: number): void {
    if (this.index === null) return;
    this.line.visible = this.parts.entities.matrixOf(this.index, now, this.matrix);
    this.ends[0]!.copy(this.hook).applyMatrix4(this.matrix);
    this.line.geometry.setFromPoints(this.ends);
  }
}
