// SPDX-License-Identifier: MIT
import { Matrix4, Quaternion, Vector3 } from "three";
import type { PoseEdit } from "../connection/messages";
import type { Parts } from "../parts";

export interface HeldPose {
  position: Vector3;
  rotation: Quaternion;
  scale: number;
}

/** The poses at which entities are drawn now. */
export function presentPoses(parts: Pick<Parts, "entities">, indices: Iterable<number>): Map<number, HeldPose> {
  const poses = new Map<number, HeldPose>();
  const matrix = new Matrix4();
  const size = new Vector3();
  for (const index of indices) {
    if (!parts.entities.matrixOf(index, performance.now(), matrix)) continue;
    const pose = { position: new Vector3(), rotation: new Quaternion(), scale: 1 };
    matrix.decompose(pose.position, pose.rotation, size);
    pose.scale = size.x;
    poses.set(index, pose);
  }
  return poses;
}

/**
 * One drag of entities by the user. They follow the pointer at once; poses are sent as fast as the server answers, all with
 * one merge key, so that one undo takes the drag back.
 */
export class PoseDrag {
  private static count = 0;
  readonly start: ReadonlyMap<number, HeldPose>;
  readonly merge = `drag-${Date.now()}-${PoseDrag.count++}`;
  private sending: Promise<unknown> | null = null;
  private newer = false;

  constructor(
    private readonly parts: Pick<Parts, "server" | "motion" | "entities" | "view">,
    indices: Iterable<number>,
  ) {
    this.start = presentPoses(parts, indices);
    for (const [index, pose] of this.start)
      parts.entities.held.set(index, { position: pose.position.clone(), rotation: pose.rotation.clone(), scale: pose.scale });
  }

  /** Draws an entity at the changed pose. Call send() after all of them. */
  hold(index: number, change: (pose: HeldPose, start: HeldPose) => void): void {
    const held = this.parts.entities.held.get(index);
    const start = this.start.get(index);
    if (!held || !start) return;
    change(held, start);
    this.parts.motion.moved.add(index);
    this.parts.view.invalidate();
  }

  /** Sends the poses to the server; at most one message is on its way. */
  send(): void {
    this.newer = true;
    if (this.sending) return;
    this.sending = this.tell().then(() => {
      this.sending = null;
      if (this.newer) this.send();
    });
  }

  /**
   * Ends once the server has the last pose, so that no entity jumps back in between. That pose is sent without waiting for the
   * answer to the one before: an undo right after the release comes after it.
   */
  async end(): Promise<void> {
    await Promise.all([this.sending, this.newer && this.tell()]);
    for (const [index] of this.start) {
      const held = this.parts.entities.held.get(index);
      if (held) this.parts.motion.place(index, held.position.toArray(), held.rotation.toArray());
      this.parts.entities.held.delete(index);
      this.parts.motion.moved.add(index);
    }
    this.parts.view.invalidate();
  }

  private tell(): Promise<unknown> {
    this.newer = false;
    return this.parts.server.command("entity.transform", { poses: this.poses(), merge: this.merge });
  }

  private poses(): PoseEdit[] {
    return [...this.start.keys()].flatMap((index) => {
      const held = this.parts.entities.held.get(index);
      return held ? [{ index, position: held.position.toArray(), rotation: held.rotation.toArray() as [number, number, number, number] }] : [];
    });
  }
}
