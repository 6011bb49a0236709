// SPDX-License-Identifier: MIT
import type { TimeMark } from "../connection/messages";
import { nameOf, type SceneDocument } from "../document/scene_document";

/** A time for people: "12.34 s", "1:02.50". */
export function timeText(seconds: number): string {
  if (seconds < 60) return `${seconds.toFixed(2)} s`;
  const minutes = Math.floor(seconds / 60);
  return `${minutes}:${(seconds - 60 * minutes).toFixed(2).padStart(5, "0")}`;
}

/** What a mark tells, such as “Contact of Ball and Floor, 3.2 N s”. */
export function markText(mark: TimeMark, scene: Pick<SceneDocument, "entity">): string {
  const name = (index?: number) => {
    const entity = index === undefined ? undefined : scene.entity(index);
    return entity ? nameOf(entity) : "a hand";
  };
  switch (mark.kind) {
    case "contact":
      return `Contact of ${name(mark.a)} and ${name(mark.b)}, ${(mark.impulse ?? 0).toPrecision(2)} N s`;
    case "action":
      return `Action ${mark.name ? `“${mark.name}”` : ""}`.trim();
    case "rope_broke":
      return `${name(mark.a)} broke`;
    case "hand":
      return `A hand took ${name(mark.a)}`;
    case "branch":
      return "The run went on anew from here";
  }
}
