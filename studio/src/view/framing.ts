// SPDX-License-Identifier: MIT
import { Box3, Vector3 } from "three";
import type { Entity } from "../connection/scene_types";
import { positionOf, type SceneDocument } from "../document/scene_document";
import type { CameraRig } from "./camera_rig";
import type { EntityView } from "./entity_view";

/** Categories of what surrounds a scene rather than being in it. */
const SURROUNDINGS = new Set(["floor", "wall", "ceiling", "room"]);
/** A flat thing this many times as wide as everything else together is a ground, whatever it is called. */
const HUGE = 2;
/** What is thinner than this part of its length is flat. */
const FLAT = 0.15;
/** Free space around what is framed, m: room to add something. */
const MARGIN = 0.5;

/** The camera that a scene is opened with: its own, or one that shows its things rather than its floor and walls. */
export class Framing {
  /** Models are still being loaded, so that the things' sizes are not known yet, and the user has not moved the camera. */
  private unfinished = false;

  constructor(
    private readonly document: SceneDocument,
    private readonly entities: EntityView,
    private readonly rig: CameraRig,
  ) {
    rig.steered.on(() => (this.unfinished = false));
    entities.loaded.on(() => {
      if (this.unfinished && entities.loading === 0) this.frame();
    });
  }

  /** The scene was opened. */
  open(): void {
    this.unfinished = false;
    const { camera } = this.document;
    if (camera) this.rig.place(camera.position, camera.target);
    else this.frame();
  }

  /** What is worth looking at: everything but floors, walls, what is locked, and grounds. Empty for an empty scene. */
  contents(): Box3 {
    const all = [...this.document.entities.values()];
    const things = this.withoutGrounds(all.filter((entity) => !isSurrounding(entity)));
    const boxes = things.length > 0 ? things : this.boxes(all);
    return boxes.reduce((whole, box) => whole.union(box), new Box3());
  }

  /** Moves the camera, smoothly or with a jump, until the contents fill the picture. */
  show(jump: boolean): void {
    const bounds = this.contents();
    if (!bounds.isEmpty()) this.rig.focus(bounds.expandByScalar(MARGIN), performance.now(), jump);
  }

  private frame(): void {
    this.unfinished = this.entities.loading > 0;
    this.show(true);
  }

  private withoutGrounds(things: Entity[]): Box3[] {
    const boxes = this.boxes(things).sort((a, b) => diagonal(b) - diagonal(a));
    for (;;) {
      const [largest, ...others] = boxes;
      const rest = others.reduce((whole, box) => whole.union(box), new Box3());
      if (!largest || rest.isEmpty() || !isFlat(largest) || diagonal(largest) < HUGE * diagonal(rest)) return boxes;
      boxes.shift();
    }
  }

  /** The boxes of entities; a model that is still being loaded counts as a point. */
  private boxes(entities: Entity[]): Box3[] {
    const now = performance.now();
    return entities.flatMap((entity) => {
      const box = this.entities.boundsOf([entity.index], now);
      if (!box.isEmpty()) return [box];
      return entity.model ? [new Box3().expandByPoint(new Vector3(...positionOf(entity.pose)))] : [];
    });
  }
}

function isSurrounding({ locked, category, attributes, shape }: Entity): boolean {
  const named = category ?? attributes?.["category"];
  return locked === true || shape?.type === "plane" || shape?.type === "heightfield" || (typeof named === "string" && SURROUNDINGS.has(named));
}

function diagonal(box: Box3): number {
  return box.getSize(new Vector3()).length();
}

function isFlat(box: Box3): boolean {
  const { x, y, z } = box.getSize(new Vector3());
  return Math.min(x, y, z) < FLAT * Math.max(x, y, z);
}
