// SPDX-License-Identifier: MIT
import { Box3, type BufferGeometry, Matrix4, Triangle, Vector3 } from "three";
import type { Entity } from "../connection/scene_types";
import { BodyState } from "../document/motion";
import type { Parts } from "../parts";

/** So near to the hand a thing is grabbed by touching it, m of the room. */
export const GRAB_REACH = 0.08;

const matrix = new Matrix4();
const inverse = new Matrix4();
const local = new Vector3();
const inPart = new Vector3();
const closest = new Vector3();
const size = new Vector3();
const box = new Box3();
const triangle = new Triangle();
const partInverse = new Matrix4();

/** Whether the user has locked the entity in its place. */
export function isLocked(entity: Entity | undefined): boolean {
  return entity?.locked === true;
}

/** Whether a hand may move it now: nothing locked or endless, and in a run only what moves. */
export function isMovable(parts: Pick<Parts, "document" | "playback" | "motion">, index: number): boolean {
  const entity = parts.document.entity(index);
  const shape = entity?.shape?.type;
  if (!entity || isLocked(entity) || shape === "plane" || shape === "heightfield" || shape === "mesh") return false;
  return parts.playback.simulation.state === "stopped" || parts.motion.state(index) !== BodyState.still;
}

/** The movable entity whose surface is nearest to a point, within `reach` metres; null where there is none. */
export function nearestEntity(parts: Pick<Parts, "document" | "playback" | "motion" | "entities">, point: Vector3, reach: number): number | null {
  const { document } = parts;
  let nearest: number | null = null;
  let least = reach;
  const look = (index: number): void => {
    if (!isMovable(parts, index)) return;
    const distance = distanceTo(parts, index, point, least);
    if (distance < least) [nearest, least] = [index, distance];
  };
  for (const index of document.entities.keys()) if (!document.spawned.has(index) && !document.absent.has(index)) look(index);
  for (const index of document.spawned.keys()) look(index);
  return nearest;
}

/** Distance of a point from an entity's drawn surface, or Infinity beyond `reach`; within a cloud of points that of its box. */
function distanceTo(parts: Pick<Parts, "entities">, index: number, point: Vector3, reach: number): number {
  const { entities } = parts;
  const now = performance.now();
  const cloud = entities.clouds.of(index);
  if (cloud) return cloud.bounds.distanceToPoint(point);
  const drawable = entities.drawableOf(index);
  if (!drawable || !entities.matrixOf(index, now, matrix)) return Infinity;
  const scale = size.setFromMatrixScale(matrix).x;
  local.copy(point).applyMatrix4(inverse.copy(matrix).invert());
  if (drawable.bounds.distanceToPoint(local) * scale > reach) return Infinity;
  let least = Infinity;
  for (const part of drawable.parts) {
    inPart.copy(local).applyMatrix4(partInverse.copy(part.matrix).invert());
    const partScale = scale * size.setFromMatrixScale(part.matrix).x;
    part.geometry.boundingBox ?? part.geometry.computeBoundingBox();
    if (box.copy(part.geometry.boundingBox!).distanceToPoint(inPart) * partScale > Math.min(reach, least)) continue;
    least = Math.min(least, nearestOfGeometry(part.geometry, inPart) * partScale);
  }
  return least;
}

function nearestOfGeometry(geometry: BufferGeometry, point: Vector3): number {
  const places = geometry.getAttribute("position");
  const corners = geometry.index;
  const count = corners ? corners.count : places.count;
  let least = Infinity;
  for (let at = 0; at + 2 < count; at += 3) {
    triangle.a.fromBufferAttribute(places, corners ? corners.getX(at) : at);
    triangle.b.fromBufferAttribute(places, corners ? corners.getX(at + 1) : at + 1);
    triangle.c.fromBufferAttribute(places, corners ? corners.getX(at + 2) : at + 2);
    least = Math.min(least, triangle.closestPointToPoint(point, closest).distanceToSquared(point));
  }
  return Math.sqrt(least);
}
