// SPDX-License-Identifier: MIT
import { Vector3 } from "three";
import type { Drop } from "../connection/messages";
import type { Parts } from "../parts";

/**
 * A drag of things over surfaces: onto tables, along walls. The server decides where they come to lie, as when they are added;
 * it is asked as fast as it answers, all with one merge key, so that one undo takes the drag back.
 */
export class SurfaceDrag {
  private static count = 0;
  private readonly merge = `surface-${Date.now()}-${SurfaceDrag.count++}`;
  /** From the pointer to the point that the server puts under a ray, px. */
  private offset: { x: number; y: number } | null = null;
  private wanted: { x: number; y: number; snap: boolean } | null = null;
  private sending: Promise<void> | null = null;
  private readonly indices: number[];

  /** `lead` is the thing under the pointer, which was pressed at this place of the page. */
  constructor(
    private readonly parts: Pick<Parts, "server" | "view">,
    lead: number,
    others: readonly number[],
    private readonly startX: number,
    private readonly startY: number,
  ) {
    this.indices = [lead, ...others.filter((index) => index !== lead)];
  }

  moveTo(x: number, y: number, snap: boolean): void {
    this.wanted = { x, y, snap };
    this.sending ??= this.send().finally(() => (this.sending = null));
  }

  /** Resolves once the server has the last place, which is sent at once: an undo right after the release comes after it. */
  async end(): Promise<void> {
    await Promise.all([this.offset && this.tell(this.offset), this.sending]);
  }

  private async send(): Promise<void> {
    const { server, view } = this.parts;
    if (!this.offset) {
      const now = await server.command("entity.preview", { index: this.indices[0]! });
      const at = now?.point && view.project(new Vector3(...now.point));
      this.offset = at ? { x: at.x - this.startX, y: at.y - this.startY } : { x: 0, y: 0 };
    }
    // A refusal was told to the user; the next move would only repeat it.
    while (this.wanted) if (!(await this.tell(this.offset))) return;
  }

  /** Sends the newest place, if there is one that was not sent; whether the server took it. */
  private async tell(offset: { x: number; y: number }): Promise<boolean> {
    if (!this.wanted) return true;
    const { x, y, snap } = this.wanted;
    this.wanted = null;
    const drop = dropAt(this.parts, x + offset.x, y + offset.y, snap);
    return (await this.parts.server.command("entity.drag", { indices: this.indices, drop, merge: this.merge })) !== undefined;
  }
}

/** The pointer's ray as the server's commands take it. */
export function dropAt(parts: Pick<Parts, "view">, x: number, y: number, snap = true): Drop {
  const { origin, direction } = parts.view.ray(x, y);
  return { origin: origin.toArray(), direction: direction.toArray(), ...(!snap && { snap }) };
}
