// SPDX-License-Identifier: MIT
// Poses as numbers that people type: metres, and degrees about Y, then X, then Z.
import { Euler, Quaternion } from "three";
import type { Entity, Quaternion as Rotation, Vector } from "../connection/scene_types";
import { positionOf, rotationOf } from "../document/scene_document";
import type { Parts } from "../parts";
import { presentPoses } from "./poses";

const DEGREE = Math.PI / 180;
const ORDER = "YXZ";
const euler = new Euler();
const turn = new Quaternion();

/** The pose of an entity now: while nothing runs the document's, which is more exact than the drawn one. */
export function presentPose(parts: Pick<Parts, "playback" | "entities">, entity: Entity): { position: Vector; degrees: Vector } {
  const live = parts.playback.simulation.state !== "stopped" || parts.entities.held.has(entity.index);
  const pose = live ? presentPoses(parts, [entity.index]).get(entity.index) : undefined;
  if (pose) return { position: pose.position.toArray(), degrees: degreesOf(pose.rotation.toArray() as Rotation) };
  return { position: positionOf(entity.pose), degrees: degreesOf(rotationOf(entity.pose)) };
}

function degreesOf(rotation: Rotation): Vector {
  euler.setFromQuaternion(turn.fromArray(rotation).normalize(), ORDER);
  return [euler.x / DEGREE, euler.y / DEGREE, euler.z / DEGREE];
}

export function rotationOfDegrees(degrees: readonly number[]): Rotation {
  const [x, y, z] = degrees.map((angle) => angle * DEGREE) as Vector;
  return turn.setFromEuler(euler.set(x, y, z, ORDER)).toArray() as Rotation;
}
