// SPDX-License-Identifier: MIT
import { Group } from "three";
import type { Frame, PointSet } from "../connection/frame";
import { Signal } from "../signal";
import { LiquidSurface } from "./liquid_surface";
import type { FromLiquidWorker, ToLiquidWorker } from "./liquid_worker";
import { PointCloud } from "./point_cloud";
import type { Quality } from "./tint";
import { blend } from "../document/blend";

/** Drawings of all entities that have points: balls, or the surface of a liquid. */
export class PointClouds {
  readonly group = new Group();
  /** A surface is ready to be drawn. */
  readonly surfaced = new Signal<number>();
  private readonly clouds = new Map<number, PointCloud | LiquidSurface>();
  /** Surfaces cannot be computed any more: the reason, and the entities that are now drawn as drops. */
  readonly lost = new Signal<{ reason: string; indices: number[] }>();
  private worker: Worker | null = null;
  private hasFailed = false;
  private lastFrame = 0;

  constructor(private quality: Quality) {}

  of(index: number): PointCloud | LiquidSurface | undefined {
    return this.clouds.get(index);
  }

  /** Takes a frame's points; returns the entities that got points or lost them. */
  take(frame: Frame, now: number, smooth: boolean): number[] {
    const changed: number[] = [];
    frame.indices.forEach((index, record) => {
      if (!frame.pointed[record] && this.drop(index)) changed.push(index);
    });
    const duration = smooth ? Math.min(now - this.lastFrame, blend.longest) : 0;
    this.lastFrame = now;
    for (const set of frame.sets) {
      // Points without a radius carry a drawn form and are not drawn themselves.
      if (!(set.radius > 0)) {
        if (this.drop(set.index)) changed.push(set.index);
        continue;
      }
      const known = this.clouds.get(set.index);
      if (known?.accepts(set)) {
        known.take(set, now, duration);
        continue;
      }
      this.drop(set.index);
      this.put(set);
      changed.push(set.index);
    }
    return changed;
  }

  private put(set: PointSet): void {
    const cloud =
      set.liquid && !this.hasFailed
        ? new LiquidSurface(set.index, set, this.quality, (message) => this.tell(message))
        : new PointCloud(set.index, set, this.quality);
    this.clouds.set(set.index, cloud);
    this.group.add(cloud.mesh);
  }

  /** Moves points towards their new positions; returns whether any are still moving. */
  advance(now: number): boolean {
    let moving = false;
    for (const cloud of this.clouds.values()) moving = cloud.advance(now) || moving;
    return moving;
  }

  /** Moves all points to their positions at once, and waits for the surfaces of liquids. */
  async settle(now: number): Promise<void> {
    for (;;) {
      this.advance(now);
      if ([...this.clouds.values()].every((cloud) => !cloud.isLiquid || cloud.isSettled)) return;
      await new Promise<void>((done) => {
        const stop = [this.surfaced.on(() => end()), this.lost.on(() => end())];
        const end = () => {
          for (const each of stop) each();
          done();
        };
      });
    }
  }

  setQuality(quality: Quality): void {
    this.quality = quality;
    for (const cloud of this.clouds.values()) cloud.setQuality(quality);
  }

  drop(index: number): boolean {
    const cloud = this.clouds.get(index);
    if (!cloud) return false;
    this.clouds.delete(index);
    this.group.remove(cloud.mesh);
    cloud.dispose();
    return true;
  }

  clear(): void {
    for (const index of [...this.clouds.keys()]) this.drop(index);
  }

  private tell(message: ToLiquidWorker): void {
    if (this.hasFailed) return;
    this.worker ??= this.start();
    this.worker.postMessage(message);
  }

  private start(): Worker {
    const worker = new Worker(new URL("./liquid_worker.ts", import.meta.url), { type: "module" });
    worker.onmessage = (event: MessageEvent<FromLiquidWorker>) => {
      const surface = this.clouds.get(event.data.index);
      if (!surface?.isLiquid) return;
      surface.show(event.data);
      this.surfaced.emit(event.data.index);
    };
    worker.onerror = (event) => this.fail(event.message || "its program could not be loaded");
    worker.onmessageerror = () => this.fail("a message could not be read");
    return worker;
  }

  /** The worker has failed: the drops themselves are drawn. */
  private fail(reason: string): void {
    if (this.hasFailed) return;
    this.hasFailed = true;
    this.worker?.terminate();
    this.worker = null;
    const surfaces = [...this.clouds.values()].filter((cloud) => cloud.isLiquid);
    for (const { index, set } of surfaces) {
      this.drop(index);
      this.put(set);
    }
    this.lost.emit({ reason, indices: surfaces.map(({ index }) => index) });
  }
}
