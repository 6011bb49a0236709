// SPDX-License-Identifier: MIT
// Locked entities stay where they are: what the user asks for is sent for the others, and one message names those that stayed.
import { nameOf } from "../document/scene_document";
import type { Parts } from "../parts";

export function isLocked(parts: Pick<Parts, "document">, index: number): boolean {
  return parts.document.entity(index)?.locked === true;
}

export function unlocked(parts: Pick<Parts, "document">, indices: Iterable<number>): number[] {
  return [...indices].filter((index) => !isLocked(parts, index));
}

/** The entities that are not locked; the user is told of the others. */
export function withoutLocked(parts: Pick<Parts, "server" | "notices" | "document">, indices: readonly number[]): number[] {
  const locked = indices.filter((index) => isLocked(parts, index));
  if (locked.length > 0) {
    const first = nameOf(parts.document.entity(locked[0]!)!);
    const others = locked.length === 1 ? "" : locked.length === 2 ? " and 1 other" : ` and ${locked.length - 1} others`;
    parts.notices.tell({
      level: "info",
      text: `${first}${others} ${locked.length === 1 ? "is" : "are"} locked and stayed`,
      action: { label: "Unlock", run: () => setLocked(parts, locked, false) },
    });
  }
  return unlocked(parts, indices);
}

export function setLocked(parts: Pick<Parts, "server">, indices: readonly number[], locked: boolean): void {
  void parts.server.command("entity.lock", { indices: [...indices], locked });
}

/** Whether all of these are locked; false for none. */
export function allLocked(parts: Pick<Parts, "document">, indices: readonly number[]): boolean {
  return indices.length > 0 && indices.every((index) => isLocked(parts, index));
}

/** Unlocks where all are locked, else locks. */
export function toggleLock(parts: Pick<Parts, "server" | "document">, indices: readonly number[]): void {
  if (indices.length > 0) setLocked(parts, indices, !allLocked(parts, indices));
}
