// SPDX-License-Identifier: MIT
import { Quaternion, Vector3 } from "three";
import type { Entity, WallOpening, WallShape } from "../connection/scene_types";
import type { Parts } from "../parts";
import { positionOf, rotationOf } from "./scene_document";

/** A wall of the scene with its frame. */
export interface Wall {
  index: number;
  shape: WallShape;
  position: Vector3;
  rotation: Quaternion;
  /** Ends of its middle line, at its foot. */
  start: Vector3;
  end: Vector3;
}

export function wallOf(entity: Entity): Wall | null {
  if (entity.shape?.type !== "wall") return null;
  const position = new Vector3(...positionOf(entity.pose));
  const rotation = new Quaternion(...rotationOf(entity.pose));
  const end = new Vector3(entity.shape.length, 0, 0).applyQuaternion(rotation).add(position);
  return { index: entity.index, shape: entity.shape, position, rotation, start: position.clone(), end };
}

export function wallsOf({ entities }: Pick<Parts["document"], "entities">): Wall[] {
  return [...entities.values()].flatMap((entity) => wallOf(entity) ?? []);
}

/** A point of the world in the wall's frame. */
export function inWall(wall: Wall, point: Vector3): Vector3 {
  return point.clone().sub(wall.position).applyQuaternion(wall.rotation.clone().invert());
}

/** The opening with a new place, kept within the wall. */
export function movedOpening(wall: WallShape, opening: WallOpening, offset: number, sill = opening.sill ?? 0): WallOpening {
  const within = (value: number, room: number) => Math.min(Math.max(value, 0), Math.max(room, 0));
  return { ...opening, offset: within(offset, wall.length - opening.width), sill: within(sill, wall.height - opening.height) };
}
