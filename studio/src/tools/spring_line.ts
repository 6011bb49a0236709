// SPDX-License-Identifier: MIT
import { BufferGeometry, Line, LineBasicMaterial, Matrix4, Vector3 } from "three";
import type { Studio } from "../studio";

/** The spring between a body that is pulled and the pointer, drawn as a line over everything. */
export class SpringLine {
  private readonly ends = [new Vector3(), new Vector3()];
  private readonly line = new Line(new BufferGeometry().setFromPoints(this.ends), new LineBasicMaterial({ color: 0xff9d2e, depthTest: false, transparent: true }));
  /** Where it holds the body, in the body's own frame. */
  private readonly hook = new Vector3();
  private readonly matrix = new Matrix4();
  private index: number | null = null;

  constructor(private readonly studio: Studio) {
    this.line.visible = false;
    this.line.frustumCulled = false;
    this.line.renderOrder = 2;
    this.line.raycast = () => {};
    studio.view.scene.add(this.line);
    studio.view.beforeFrame.on((now) => this.follow(now));
  }

  /** Holds body `index` at a point of the world. */
  begin(index: number, point: Vector3): void {
    if (!this.studio.entities.matrixOf(index, performance.now(), this.matrix)) return;
    this.index = index;
    this.hook.copy(point).applyMatrix4(this.matrix.invert());
    this.pullTo(point);
  }

  pullTo(target: Vector3): void {
    this.ends[1]!.copy(target);
    this.studio.view.invalidate();
  }

  end(): void {
    this.index = null;
    this.line.visible = false;
    this.studio.view.invalidate();
  }

  private follow(now: number): void {
    if (this.index === null) return;
    this.line.visible = this.studio.entities.matrixOf(this.index, now, this.matrix);
    this.ends[0]!.copy(this.hook).applyMatrix4(this.matrix);
    this.line.geometry.setFromPoints(this.ends);
  }
}
