// SPDX-License-Identifier: MIT
// Locked entities stay where they are: what the user asks for is sent for the others, and one message names those that stayed.
import { nameOf } from "../document/scene_document";
import type { Parts } from "../parts";
import { t } from "../language";

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
    parts.notices.tell({
      level: "info",
      text: locked.length === 1 ? t("{{name}} is locked and stayed", { name: first }) : t("{{name}} and {{count}} others are locked and stayed", { name: first, count: locked.length - 1 }),
      action: { label: t("Unlock"), run: () => setLocked(parts, locked, false) },
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
