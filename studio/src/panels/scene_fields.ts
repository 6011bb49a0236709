// SPDX-License-Identifier: MIT
import type { SceneSettings } from "../connection/scene_types";
import { withTyped } from "../document/components";
import type { Parts } from "../parts";
import { element, setText, show } from "./element";
import { type Components, numberField, textField, truthField, vectorField } from "./fields";

/** The scene's own settings, shown while nothing is selected. */
export class SceneFields {
  readonly root: HTMLElement;
  private readonly title = textField("Title", (title) => this.set({ title }));
  private readonly gravity = vectorField(["Gravity x", "Gravity y", "Gravity z"], "m/s²", (typed) => this.setVector("gravity", typed));
  private readonly timeStep = numberField("Time step", "s", (time_step) => this.set({ time_step }));
  private readonly substeps = numberField("Substeps", "", (substeps) => this.set({ substeps }), { step: 1 });
  private readonly sleeping = truthField("Sleeping", (sleeping) => this.set({ sleeping }));
  private readonly wind = vectorField(["Wind x", "Wind y", "Wind z"], "m/s", (typed) => this.setVector("wind", typed));
  private readonly gustiness = numberField("Gustiness", "", (gustiness) => this.set({ gustiness }));
  private readonly gustTime = numberField("Gust time", "s", (gust_time) => this.set({ gust_time }));
  private readonly airDensity = numberField("Air density", "kg/m³", (air_density) => this.set({ air_density }));
  private readonly contents = element("p", { class: "note", "data-testid": "scene-contents" });

  constructor(private readonly parts: Pick<Parts, "server" | "document" | "selection" | "picked">) {
    const row = (label: string, field: HTMLElement, help: string) =>
      element("div", { class: "attribute" }, element("span", { class: "attribute-label", title: help }, label), field);
    this.root = element(
      "section",
      { class: "entity", "aria-label": "Scene", "data-testid": "scene-fields" },
      element("h2", {}, "Scene"),
      this.contents,
      element(
        "details",
        { class: "group", open: true },
        element("summary", {}, "World"),
        row("Title", this.title.root, "What the scene is called"),
        row("Gravity", this.gravity.root, "Acceleration of free fall"),
        row("Time step", this.timeStep.root, "Simulated time of one step"),
        row("Substeps", this.substeps.root, "Substeps of a step: more are stiffer and slower"),
        row("Sleeping", this.sleeping.root, "Bodies at rest cost nothing until they are touched"),
      ),
      element(
        "details",
        { class: "group", open: true },
        element("summary", {}, "Air"),
        row("Wind", this.wind.root, "Velocity of the air"),
        row("Gustiness", this.gustiness.root, "How much the wind changes: 0 is steady, 0.2 a usual wind, 1 gusts as strong as the wind"),
        row("Gust time", this.gustTime.root, "How long a gust lasts"),
        row("Air density", this.airDensity.root, "Of the air"),
      ),
      element("p", { class: "note" }, "Select an entity, or click on a model, to see what it is made of. Drag models in from the left; they land on what is under the pointer."),
    );
    parts.document.changed.on(() => this.update());
    parts.selection.changed.on(() => this.update());
    parts.picked.changed.on(() => this.update());
    this.update();
  }

  private setVector(name: "gravity" | "wind", typed: Components): void {
    this.set({ [name]: withTyped(this.parts.document.settings[name], typed) });
  }

  private set(settings: Partial<SceneSettings> & { title?: string }): void {
    void this.parts.server.command("scene.settings", settings).then(() => this.update());
  }

  private update(): void {
    const { document: scene, selection, picked } = this.parts;
    show(this.root, selection.indices.length === 0 && !picked.model);
    this.title.set(scene.title);
    this.gravity.set(scene.settings.gravity);
    this.timeStep.set(scene.settings.time_step);
    this.substeps.set(scene.settings.substeps);
    this.sleeping.set(scene.settings.sleeping);
    this.wind.set(scene.settings.wind);
    this.gustiness.set(scene.settings.gustiness);
    this.gustTime.set(scene.settings.gust_time);
    this.airDensity.set(scene.settings.air_density);
    const parts = [count(scene.entities.size, "entity", "entities"), count(scene.joints.size, "joint", "joints"), count(scene.actions.size, "action", "actions")];
    setText(this.contents, [parts.join(", "), scene.description].filter(Boolean).join(". "));
  }
}

function count(number: number, one: string, many: string): string {
  return `${number} ${number === 1 ? one : many}`;
}
