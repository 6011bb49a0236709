// SPDX-License-Identifier: MIT
import type { Level } from "../connection/scene_types";
import type { Parts } from "../parts";
import type { UserAction } from "../tools/actions";
import type { BuildTool } from "../tools/build_tool";
import { element, show } from "./element";
import { t } from "../language";

/** What stands so much below a level's top is above it already, m. */
const SLACK = 0.05;
/** Of a scene without levels: what stands higher hides the plan, m. */
const USUAL_CEILING = 2.4;
/** Between the ceiling of one level and the floor of the next, m. */
const SLAB = 0.2;

export function planActions({ view }: Pick<Parts, "view">): UserAction[] {
  return [{ id: "view.plan", label: t("Plan from above"), group: t("View"), keys: ["P"], icon: "plan", on: () => view.rig.isPlan, run: () => view.rig.setPlan(!view.rig.isPlan) }];
}

/** The storeys of the building: which one is built on, and whether those above are shown. Shown with the plan, and wherever a scene has levels. */
export class LevelBar {
  readonly root: HTMLElement;
  private chosen = 0;
  private readonly list = element("select", { "aria-label": t("Level"), "data-testid": "levels" });
  private readonly hide = element("input", { type: "checkbox", "data-testid": "hide-above" });
  private readonly name = element("input", { class: "level-name", "aria-label": t("Name of the level"), "data-testid": "level-name" });
  private readonly elevation = element("input", { type: "number", step: 0.1, "aria-label": t("Elevation, m"), "data-testid": "level-elevation" });
  private readonly height = element("input", { type: "number", step: 0.1, min: 0.1, "aria-label": t("Height, m"), "data-testid": "level-height" });
  private readonly remove = element("button", { "data-testid": "level-remove" }, t("Remove"));
  private readonly fields: HTMLElement;
  private readonly hideLabel: HTMLElement;

  constructor(
    private readonly parts: Pick<Parts, "server" | "document" | "entities" | "view">,
    private readonly build: BuildTool,
  ) {
    this.hideLabel = element("label", {}, this.hide, t("Hide what is above"));
    this.fields = element("span", { class: "level-fields" }, this.name, element("label", {}, t("at"), this.elevation, "m"), element("label", {}, t("high"), this.height, "m"), this.remove);
    this.root = element(
      "div",
      { class: "level-bar", role: "toolbar", "aria-label": t("Levels"), "data-testid": "level-bar" },
      this.list,
      element("button", { "data-testid": "level-add", onclick: () => this.add() }, t("Add level")),
      this.hideLabel,
      this.fields,
    );
    this.list.addEventListener("change", () => this.choose(this.list.selectedIndex));
    this.hide.addEventListener("change", () => this.refresh());
    this.remove.addEventListener("click", () => this.send(parts.document.levels.filter((_, k) => k !== this.chosen)));
    this.name.addEventListener("change", () => this.edit({ name: this.name.value }));
    this.elevation.addEventListener("change", () => this.edit({ elevation: this.elevation.valueAsNumber }));
    this.height.addEventListener("change", () => this.edit({ height: this.height.valueAsNumber }));
    parts.document.changed.on(({ settings, all }) => (settings || all) && this.refresh());
    parts.view.rig.planned.on(() => this.refresh());
    this.refresh();
  }

  private choose(level: number): void {
    this.chosen = level;
    this.refresh();
  }

  private add(): void {
    const { levels } = this.parts.document;
    const last = levels.at(-1) ?? { name: t("Ground floor"), elevation: 0, height: this.build.height };
    const next: Level = { name: t("Level {{number}}", { number: Math.max(levels.length, 1) }), elevation: (last.elevation ?? 0) + (last.height ?? 2.5) + SLAB, height: last.height ?? 2.5 };
    const all = levels.length > 0 ? [...levels, next] : [last, next];
    this.chosen = all.length - 1;
    this.send(all);
  }

  private edit(change: Partial<Level>): void {
    if (Object.values(change).some((value) => typeof value === "number" && !Number.isFinite(value))) return this.refresh();
    this.send(this.parts.document.levels.map((level, k) => (k === this.chosen ? { ...level, ...change } : level)));
  }

  private send(levels: Level[]): void {
    // A refusal leaves the fields as the document has them.
    void this.parts.server.command("scene.settings", { levels }).then(() => this.refresh());
  }

  private refresh(): void {
    const { document, entities, view } = this.parts;
    const { levels } = document;
    const isPlan = view.rig.isPlan;
    this.chosen = Math.min(this.chosen, Math.max(levels.length - 1, 0));
    const level = levels[this.chosen];
    show(this.root, isPlan || levels.length > 0);
    show(this.list, levels.length > 0);
    // The plan hides it always.
    show(this.hideLabel, !isPlan && levels.length > 0);
    show(this.fields, level !== undefined);
    this.list.replaceChildren(...levels.map(({ name }, k) => element("option", { selected: k === this.chosen }, name || t("Level {{number}}", { number: k }))));
    if (level) {
      this.name.value = level.name ?? "";
      this.elevation.value = String(level.elevation ?? 0);
      this.height.value = String(level.height ?? 2.5);
    }
    this.build.base = level?.elevation ?? 0;
    const hides = isPlan || (this.hide.checked && level !== undefined);
    const top = level ? (level.elevation ?? 0) + (level.height ?? 2.5) - SLACK : USUAL_CEILING;
    entities.cutAbove(hides ? top : Infinity);
  }
}
