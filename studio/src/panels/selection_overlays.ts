// SPDX-License-Identifier: MIT
import type { DebugName } from "../connection/debug_frame";
import type { Parts } from "../parts";
import { element, show } from "./element";
import { t } from "../language";

const OVERLAYS: readonly { name: DebugName; label: string; title: string }[] = [
  { name: "masses", label: t("Centre of mass"), title: t("The point that it balances on, and three lines as long as the box that turns like it") },
  { name: "contacts", label: t("Contacts"), title: t("Where it touches, and the direction in which it is pushed") },
  { name: "forces", label: t("Forces"), title: t("Red: its weight. Violet: the constant force. Orange: what pushes it where it touches. The longest arrow is the largest force") },
  { name: "velocities", label: t("Velocity"), title: t("An arrow to where it will be in a fifth of a second") },
];

/** What the picture shows of the forces on what is selected. */
export class SelectionOverlays {
  readonly root: HTMLElement;
  private readonly buttons = new Map<DebugName, HTMLButtonElement>();
  private readonly collision: HTMLButtonElement;

  constructor(private readonly parts: Pick<Parts, "preferences" | "selection">) {
    const { preferences } = parts;
    for (const { name, label, title } of OVERLAYS) {
      const flip = (): void => {
        const shown = preferences.get("overlays");
        preferences.set("overlays", shown.includes(name) ? shown.filter((each) => each !== name) : [...shown, name]);
      };
      this.buttons.set(name, element("button", { class: "chip", title, "data-testid": `overlay-${name}`, onclick: flip }, label));
    }
    this.collision = element(
      "button",
      { class: "chip", title: t("What collides: the convex parts (C)"), "data-testid": "overlay-collision", onclick: () => preferences.set("collision", !preferences.get("collision")) },
      t("Collision shape"),
    );
    this.root = element(
      "div",
      { class: "overlay-chips", role: "group", "aria-label": t("Show in the picture"), "data-testid": "selection-overlays" },
      element("span", { class: "note" }, t("Show:")),
      ...this.buttons.values(),
      this.collision,
    );
    preferences.changed.on(() => this.update());
    parts.selection.changed.on(() => this.update());
    this.update();
  }

  private update(): void {
    const { preferences, selection } = this.parts;
    show(this.root, selection.indices.length > 0);
    for (const [name, button] of this.buttons) button.setAttribute("aria-pressed", String(preferences.get("overlays").includes(name)));
    this.collision.setAttribute("aria-pressed", String(preferences.get("collision")));
  }
}
