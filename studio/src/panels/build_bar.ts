// SPDX-License-Identifier: MIT
import type { Parts } from "../parts";
import type { UserAction } from "../tools/actions";
import type { BuildMode, BuildTool } from "../tools/build_tool";
import { type IconName, icon } from "../tools/icons";
import { element, show } from "./element";
import { t } from "../language";

const HINTS: Record<BuildMode, string> = {
  wall: t("Click from corner to corner. Type a length and press Enter. Escape ends."),
  room: t("Drag from one corner to the opposite one."),
  door: t("Click where the door goes. Drag it along its wall afterwards."),
  window: t("Click where the window goes. Drag it along its wall afterwards."),
  hole: t("Click on a wall."),
};

/** A bar over the picture while something is built: what, how high and how thick. */
export class BuildBar {
  readonly root: HTMLElement;
  private readonly buttons: { action: UserAction; button: HTMLButtonElement }[];
  private readonly hint = element("span", { class: "build-hint", "data-testid": "build-hint" });
  private readonly sizes: HTMLElement;

  constructor(
    private readonly parts: Pick<Parts, "view">,
    private readonly tool: BuildTool,
    actions: readonly UserAction[],
  ) {
    this.buttons = actions.map((action) => ({
      action,
      button: element(
        "button",
        { class: "tool-button with-text", title: action.label, "aria-pressed": false, "data-testid": action.id, onclick: () => (action.run(), this.parts.view.canvas.focus()) },
        icon(action.icon ?? "options"),
        action.label,
      ),
    }));
    this.sizes = element("div", { class: "tool-group" }, this.size(t("Height"), "height", 0.1), this.size(t("Thickness"), "thickness", 0.01));
    this.root = element(
      "div",
      { class: "arrange-bar build-bar", role: "toolbar", "aria-label": t("Build"), "data-testid": "build-bar" },
      element("div", { class: "tool-group", role: "group" }, ...this.buttons.map(({ button }) => button)),
      this.sizes,
      this.hint,
    );
    tool.changed.on(() => this.refresh());
    this.refresh();
  }

  private size(label: string, field: "height" | "thickness", step: number): HTMLElement {
    const input = element("input", { type: "number", min: 0.05, max: 100, step, value: this.tool[field], "data-testid": `build-${field}` });
    input.addEventListener("change", () => {
      const value = input.valueAsNumber;
      if (value >= 0.05 && value <= 100) this.tool[field] = value;
      else input.value = String(this.tool[field]);
    });
    return element("label", { class: "build-size" }, label, input, "m");
  }

  private refresh(): void {
    const { mode } = this.tool;
    show(this.root, mode !== null);
    show(this.sizes, mode === "wall" || mode === "room");
    this.hint.textContent = mode ? HINTS[mode] : "";
    for (const { action, button } of this.buttons) button.setAttribute("aria-pressed", String(action.on?.() ?? false));
  }
}

export function buildActions(tool: BuildTool): UserAction[] {
  const action = (mode: BuildMode, label: string, name: IconName, keys: string[] = []): UserAction => ({
    id: `build.${mode}`,
    label,
    group: t("Build"),
    keys,
    icon: name,
    on: () => tool.mode === mode,
    run: () => tool.choose(tool.mode === mode ? null : mode),
  });
  return [
    action("wall", t("Walls"), "wall", ["B"]),
    action("room", t("Room"), "room", ["Shift+B"]),
    action("door", t("Door"), "door"),
    action("window", t("Window"), "window"),
    action("hole", t("Opening"), "hole"),
  ];
}
