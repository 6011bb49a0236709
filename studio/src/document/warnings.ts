// SPDX-License-Identifier: MIT
import type { ValueWarning } from "../connection/messages";
import type { Server } from "../connection/server";
import { Signal } from "../signal";
import type { Changed, SceneDocument } from "./scene_document";

/** Edits that follow each other, as of a drag, are asked about once, ms. */
const DELAY_MS = 250;

export type EntityWarning = ValueWarning & { attribute: string; label: string };

/** The entities whose values make no sense, as the server finds. */
export class Warnings {
  readonly changed = new Signal<void>();
  private readonly known = new Map<number, readonly EntityWarning[]>();
  private readonly stale = new Set<number>();
  private allStale = false;
  private timer = 0;

  constructor(
    private readonly server: Server,
    private readonly document: SceneDocument,
  ) {
    document.changed.on((changed) => this.note(changed));
    server.catalogChanged.on(() => this.note({ all: true, entities: [] }));
  }

  of(index: number): readonly EntityWarning[] {
    return this.known.get(index) ?? [];
  }

  /** What an edit may have changed: settings and joints decide about all. */
  private note({ all, entities, settings = false, joints = false }: Partial<Changed> & Pick<Changed, "all" | "entities">): void {
    if (all || settings || joints) this.allStale = true;
    for (const index of entities) this.stale.add(index);
    if (!this.allStale && this.stale.size === 0) return;
    clearTimeout(this.timer);
    this.timer = window.setTimeout(() => void this.ask(), DELAY_MS);
  }

  private async ask(): Promise<void> {
    const all = this.allStale;
    const indices = [...this.stale].filter((index) => this.document.entities.has(index));
    this.allStale = false;
    this.stale.clear();
    if (!all && indices.length === 0) return;
    // Who is removed meanwhile makes the answer a refusal; the next edit asks again.
    const told = await this.server.request("entity.warnings", all ? {} : { indices }).catch(() => null);
    if (!told) return;
    if (all) this.known.clear();
    for (const index of indices) this.known.delete(index);
    for (const { index, warnings } of told.entities) this.known.set(index, warnings);
    this.changed.emit();
  }
}
