// SPDX-License-Identifier: MIT
import type { SceneDocument } from "./scene_document";

/** The outermost group of a path; empty for an empty one. */
export function outermostGroup(path: string | undefined): string {
  return path?.split("/")[0] ?? "";
}

/** Whether something of this path is in the group or in a group of it. */
export function isInGroup(path: string | undefined, group: string): boolean {
  return path === group || (path ?? "").startsWith(`${group}/`);
}

export function membersOf(document: SceneDocument, group: string): number[] {
  return [...document.entities.values()].filter((entity) => isInGroup(entity.group, group)).map((entity) => entity.index);
}

/** These entities and all of the outermost groups that they are in; the given ones last, so that the last stays the last selected. */
export function withGroups(document: SceneDocument, indices: readonly number[]): number[] {
  const groups = new Set(indices.map((index) => outermostGroup(document.entity(index)?.group)).filter(Boolean));
  if (groups.size === 0) return [...indices];
  const others = [...groups].flatMap((group) => membersOf(document, group)).filter((index) => !indices.includes(index));
  return [...others, ...indices];
}
