// SPDX-License-Identifier: MIT
// Taps and drains of entities: docs/scene-format.md.
import type { Drain, Entity, Tap } from "../connection/scene_types";
import type { EntityView } from "../view/entity_view";

const NO_TAP: Tap = { litres_per_minute: 0, radius: 0.01, speed: 0, position: [0, 0, 0], liquid: 0, open: true };
const NO_DRAIN: Drain = { radius: 0, position: [0, 0, 0], open: true };

export function tapOf({ tap }: Entity): Tap {
  return tap ?? NO_TAP;
}

export function drainOf({ drain }: Entity): Drain {
  return drain ?? NO_DRAIN;
}

/** Whether it is a liquid, as far as the Studio knows: by its drops, or what was set by hand. */
export function isLiquid(entity: Entity, drawn: Pick<EntityView, "clouds">): boolean {
  return entity.starts_empty === true || entity.attributes?.["kind"] === "fluid" || drawn.clouds.of(entity.index)?.isLiquid === true;
}
