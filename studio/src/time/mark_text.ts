// SPDX-License-Identifier: MIT
import type { TimeMark } from "../connection/messages";
import { nameOf, type SceneDocument } from "../document/scene_document";
import { t } from "../language";

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
    return entity ? nameOf(entity) : t("a hand");
  };
  switch (mark.kind) {
    case "contact":
      return t("Contact of {{first}} and {{second}}, {{impulse}} N s", { first: name(mark.a), second: name(mark.b), impulse: (mark.impulse ?? 0).toPrecision(2) });
    case "action":
      return mark.name ? t("Action “{{name}}”", { name: mark.name }) : t("Action");
    case "rope_broke":
      return t("{{name}} broke", { name: name(mark.a) });
    case "sheet_tore":
      return t("{{name}} tore", { name: name(mark.a) });
    case "hand":
      return t("A hand took {{name}}", { name: name(mark.a) });
    case "branch":
      return t("The run went on anew from here");
  }
}
