// SPDX-License-Identifier: MIT
import type { Parts } from "../parts";
import type { UserAction } from "../tools/actions";
import { icon } from "../tools/icons";
import { element } from "./element";
import { t } from "../language";

type Side = "left" | "right";
const NAMES: Record<Side, string> = { left: t("models and entities"), right: t("properties") };
/** In a page no wider than this the panels lie over the scene, one at a time (style/narrow.css has the same width). */
const NARROW = "(max-width: 900px)";

/** Where the panels are: beside the scene, folded away, or on a small screen over it. */
export class Layout {
  private readonly narrow = matchMedia(NARROW);
  /** The panel that lies over the scene of a small screen. */
  private drawer: Side | null = null;
  private readonly handles: Record<Side, HTMLButtonElement>;

  constructor(
    private readonly parts: Pick<Parts, "preferences" | "view">,
    private readonly app: HTMLElement,
    scene: HTMLElement,
    private readonly panels: Record<Side, HTMLElement>,
  ) {
    const handle = (side: Side): HTMLButtonElement =>
      element("button", { class: `fold-handle ${side}`, "data-testid": `fold-${side}`, onclick: () => this.toggle(side) }, icon(side === "left" ? "foldLeft" : "foldRight"));
    this.handles = { left: handle("left"), right: handle("right") };
    scene.append(this.handles.left, this.handles.right);
    // On a small screen a tap on the scene puts the panel away. Not before the click: that would be for the handle that
    // appears under the finger.
    parts.view.canvas.addEventListener("click", () => this.drawer && this.open(null));
    this.narrow.addEventListener("change", () => this.open(null));
    parts.preferences.changed.on((name) => name === "folded" && this.apply());
    this.apply();
  }

  get actions(): UserAction[] {
    const fold = (side: Side, key: string): UserAction => ({
      id: `view.fold_${side}`,
      label: t("Fold the panel of {{panel}}", { panel: NAMES[side] }),
      group: t("View"),
      keys: [key],
      on: () => !this.isOpen(side),
      run: () => this.toggle(side),
    });
    return [fold("left", "Alt+1"), fold("right", "Alt+2")];
  }

  /** Something was dragged out of the panel or chosen in it: a drawer gives the scene free. */
  freeScene(): void {
    if (this.drawer) this.open(null);
  }

  private isOpen(side: Side): boolean {
    return this.narrow.matches ? this.drawer === side : !this.parts.preferences.get("folded").includes(side);
  }

  private toggle(side: Side): void {
    if (this.narrow.matches) return this.open(this.drawer === side ? null : side);
    const folded = this.parts.preferences.get("folded");
    this.parts.preferences.set("folded", this.isOpen(side) ? [...folded, side] : folded.filter((each) => each !== side));
  }

  private open(side: Side | null): void {
    this.drawer = side;
    this.apply();
  }

  private apply(): void {
    for (const side of ["left", "right"] as const) {
      const isOpen = this.isOpen(side);
      this.app.classList.toggle(`${side}-folded`, !isOpen);
      this.panels[side].inert = !isOpen;
      const label = isOpen ? t("Fold {{panel}}", { panel: NAMES[side] }) : t("Show {{panel}}", { panel: NAMES[side] });
      this.handles[side].setAttribute("aria-label", label);
      this.handles[side].setAttribute("aria-expanded", String(isOpen));
      this.handles[side].title = label;
    }
  }
}
