// SPDX-License-Identifier: MIT
// Places where a deformable entity can be pinned: corners, edges and ends of its nodes at rest.
import { Quaternion, Vector3 } from "three";
import type { SimulationMesh } from "../connection/messages";
import type { Entity, Pin, Vector } from "../connection/scene_types";
import { rotationOf } from "./scene_document";
import { t } from "../language";

/** Number of pins along each side of an edge or a face. */
const ALONG_AN_EDGE = 17;
const ALONG_A_FACE = 4;
/** The scene format's default. */
const RADIUS = 0.01;

export type PinPlace = "corners" | "edge" | "ends" | "end" | "top" | "bottom";

export const PLACE_LABELS: Record<PinPlace, string> = {
  corners: t("Corners"),
  edge: t("Upper edge"),
  ends: t("Both ends"),
  end: t("One end"),
  top: t("Top"),
  bottom: t("Bottom"),
};

/** The places that an entity offers to pin. */
export function placesOf(mesh: SimulationMesh): PinPlace[] {
  if (mesh.tetrahedra) return ["top", "bottom"];
  return mesh.triangles ? ["edge", "corners"] : ["ends", "end"];
}

/** Pins at a place, of nodes at rest in the entity's frame; `entity` says how it is turned in the scene. */
export function pinsAt(place: PinPlace, mesh: SimulationMesh, entity: Entity): Pin[] {
  const at = (node: number): Pin => ({ position: mesh.nodes.slice(3 * node, 3 * node + 3) as Vector });
  const last = mesh.nodes.length / 3 - 1;
  if (place === "end") return [at(0)];
  if (place === "ends") return [at(0), at(last)];

  const [lower, upper] = extents(mesh.nodes);
  const size = upper.map((value, axis) => value - lower[axis]!);
  const up = new Vector3(0, 1, 0).applyQuaternion(new Quaternion(...rotationOf(entity.pose)).invert()).toArray();
  const middle = lower.map((value, axis) => (value + upper[axis]!) / 2);
  const onGrid = (side: number, end: number, others: number[], along: number): Pin[] => {
    let pins: number[][] = [[...middle]];
    for (const axis of others)
      pins = pins.flatMap((pin) => Array.from({ length: along }, (_, k) => pin.map((value, each) => (each === axis ? lower[axis]! + (size[axis]! * k) / (along - 1) : value))));
    return pins.map((pin) => ({ position: pin.map((value, axis) => (axis === side ? end : value)) as Vector }));
  };
  if (place === "top" || place === "bottom") {
    const side = largest(up.map(Math.abs));
    const isUpper = up[side]! > 0 === (place === "top");
    return onGrid(side, isUpper ? upper[side]! : lower[side]!, [0, 1, 2].filter((axis) => axis !== side), ALONG_A_FACE);
  }
  // The axis across a sheet: along it the sheet is thinnest.
  const flat = size.indexOf(Math.min(...size));
  const [u, v] = [0, 1, 2].filter((axis) => axis !== flat) as [number, number];
  if (place === "corners") return [lower[u]!, upper[u]!].flatMap((end) => onGrid(u, end, [v], 2));
  const side = Math.abs(up[u]!) > Math.abs(up[v]!) ? u : v;
  const end = up[side]! > 0.1 ? upper[side]! : lower[side]!;
  return onGrid(side, end, [side === u ? v : u], ALONG_AN_EDGE);
}

/** The nodes that pins hold; the same rule as the scene's. */
export function heldNodes(pins: readonly Pin[], nodes: readonly number[]): number[] {
  const held = new Set<number>();
  for (const { position = [0, 0, 0], radius = RADIUS } of pins) {
    let nearest = 0;
    let least = Infinity;
    for (let node = 0; 3 * node < nodes.length; ++node) {
      const distance = Math.hypot(nodes[3 * node]! - position[0], nodes[3 * node + 1]! - position[1], nodes[3 * node + 2]! - position[2]);
      if (distance <= radius) held.add(node);
      if (distance < least) [nearest, least] = [node, distance];
    }
    if (least > radius) held.add(nearest);
  }
  return [...held];
}

/** The node nearest to a point, at the nodes' present positions. */
export function nearestNode(places: ArrayLike<number>, { x, y, z }: Vector3): number {
  let nearest = 0;
  let least = Infinity;
  for (let node = 0; 3 * node < places.length; ++node) {
    const distance = Math.hypot(places[3 * node]! - x, places[3 * node + 1]! - y, places[3 * node + 2]! - z);
    if (distance < least) [nearest, least] = [node, distance];
  }
  return nearest;
}

function extents(nodes: readonly number[]): [number[], number[]] {
  const lower = [Infinity, Infinity, Infinity];
  const upper = [-Infinity, -Infinity, -Infinity];
  nodes.forEach((value, at) => {
    lower[at % 3] = Math.min(lower[at % 3]!, value);
    upper[at % 3] = Math.max(upper[at % 3]!, value);
  });
  return [lower, upper];
}

function largest(values: number[]): number {
  return values.indexOf(Math.max(...values));
}
