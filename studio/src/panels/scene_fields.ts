// SPDX-License-Identifier: MIT
import { DEFAULT_SETTINGS, type SceneSettings, type Vector } from "../connection/scene_types";
import { withTyped } from "../document/components";
import { nameOf } from "../document/scene_document";
import type { Parts } from "../parts";
import { element, setText, show } from "./element";
import { type Components, type Field, numberField, textField, truthField, vectorField } from "./fields";
import { foldingGroup } from "./folding";
import { daylightGroup } from "./look_fields";

/** Free fall at the surface, m/s², and density of the air there, kg/m³ (NASA, Planetary Fact Sheets). */
const PLACES: readonly { name: string; gravity: number; air: number }[] = [
  { name: "Earth", gravity: 9.81, air: 1.2 },
  { name: "Moon", gravity: 1.62, air: 0 },
  { name: "Mars", gravity: 3.71, air: 0.02 },
  { name: "No weight", gravity: 0, air: 1.2 },
];

type Setting = keyof SceneSettings;

/** The world of the scene, shown while nothing is selected: where it is, its air, its ground, and, folded, how exactly it is computed. */
export class SceneFields {
  readonly root: HTMLElement;
  private readonly rows = new Map<Setting, { root: HTMLElement; field: Field<never> }>();
  private readonly title = textField("Title", (title) => this.set({ title }));
  private readonly places = PLACES.map((place) => ({
    ...place,
    button: element("button", { class: "chip", title: `Falls with ${place.gravity} m/s², air of ${place.air} kg/m³`, "data-testid": `place-${place.name}`, onclick: () => this.goTo(place) }, place.name),
  }));
  private readonly daylight: ReturnType<typeof daylightGroup>;
  private readonly contents = element("p", { class: "note", "data-testid": "scene-contents" });
  private readonly ground = element("span", { class: "field" });

  constructor(private readonly parts: Pick<Parts, "preferences" | "server" | "document" | "selection" | "picked">) {
    const { preferences } = parts;
    this.daylight = daylightGroup(parts);
    const vector = (name: "gravity" | "wind", label: string, unit: string, help: string) =>
      this.row(name, label, help, vectorField([`${label} x`, `${label} y`, `${label} z`], unit, (typed) => this.setVector(name, typed)));
    const number = (name: Setting, label: string, unit: string, help: string, step?: number) =>
      this.row(name, label, help, numberField(label, unit, (value) => this.set({ [name]: value }), { step }));
    const truth = (name: Setting, label: string, help: string) => this.row(name, label, help, truthField(label, (value) => this.set({ [name]: value })));
    this.root = element(
      "section",
      { class: "entity", "aria-label": "Scene", "data-testid": "scene-fields" },
      element("h2", {}, "Scene"),
      this.contents,
      foldingGroup(
        preferences,
        "scene.world",
        "World",
        true,
        labelled("Title", this.title.root, "What the scene is called"),
        labelled("Where it is", element("span", { class: "field preset-chips" }, ...this.places.map(({ button }) => button)), "Sets weight and air as they are there"),
        vector("gravity", "Gravity", "m/s²", "How fast things begin to fall, and where to"),
        labelled("Ground", this.ground, "What everything stands on"),
      ),
      foldingGroup(
        preferences,
        "scene.air",
        "Air and wind",
        true,
        vector("wind", "Wind", "m/s", "Where the air moves to, and how fast: it moves cloth, and slows what flies"),
        number("gustiness", "Gustiness", "", "How much the wind changes: 0 is steady, 0.2 a usual wind, 1 gusts as strong as the wind"),
        number("gust_time", "A gust lasts", "s", "How long the wind is stronger or weaker"),
        number("air_density", "Air density", "kg/m³", "Thick air slows more: 1.2 on Earth, none on the Moon"),
      ),
      foldingGroup(
        preferences,
        "scene.accuracy",
        "Simulation accuracy",
        false,
        element("p", { class: "note" }, "More exact is slower. What is set here suits nearly all scenes."),
        number("time_step", "Time step", "s", "Time between two moments that are computed: shorter is more exact, for fast and small things"),
        number("substeps", "Parts of a step", "", "Each moment is computed in so many parts: more makes stacks, joints and ropes stiffer", 1),
        truth("shock_propagation", "Firm stacks", "Computes stacks from the ground up, so that high ones stand"),
        truth("sleeping", "Rest when quiet", "What lies still is not computed until it is touched"),
        number("time_to_sleep", "Rests after", "s", "How long a thing must lie still before it rests"),
        number("max_linear_speed", "Fastest speed", "m/s", "Faster things are slowed to this, and you are told"),
        number("max_angular_speed", "Fastest spin", "rad/s", "The same for turning"),
      ),
      this.daylight.root,
      element("p", { class: "note" }, "Select an entity, or click on a model, to see what it is made of. Drag models in from the left; they land on what is under the pointer."),
    );
    parts.document.changed.on(() => this.update());
    parts.selection.changed.on(() => this.update());
    parts.picked.changed.on(() => this.update());
    this.update();
  }

  private row(name: Setting, label: string, help: string, field: Field<Components> | Field<number> | Field<boolean>): HTMLElement {
    const root = labelled(label, field.root, help);
    root.dataset["name"] = name;
    this.rows.set(name, { root, field: field as unknown as Field<never> });
    return root;
  }

  private setVector(name: "gravity" | "wind", typed: Components): void {
    this.set({ [name]: withTyped(this.parts.document.settings[name], typed) });
  }

  private goTo({ gravity, air }: { gravity: number; air: number }): void {
    this.set({ gravity: [0, -gravity, 0], air_density: air });
  }

  private set(settings: Partial<SceneSettings> & { title?: string }): void {
    void this.parts.server.command("scene.settings", settings).then(() => this.update());
  }

  private update(): void {
    const { document: scene, selection, picked } = this.parts;
    show(this.root, selection.indices.length === 0 && !picked.model);
    this.title.set(scene.title);
    for (const [name, { root, field }] of this.rows) {
      const value = scene.settings[name];
      field.set(value as never);
      root.dataset["changed"] = String(JSON.stringify(value) !== JSON.stringify(DEFAULT_SETTINGS[name]));
    }
    const [x, y, z] = scene.settings.gravity;
    for (const { button, gravity, air } of this.places) button.setAttribute("aria-pressed", String(x === 0 && z === 0 && Math.abs(y + gravity) < 0.005 && scene.settings.air_density === air));
    this.showGround();
    this.daylight.update();
    const parts = [count(scene.entities.size, "entity", "entities"), count(scene.joints.size, "joint", "joints"), count(scene.actions.size, "action", "actions")];
    setText(this.contents, [parts.join(", "), scene.description].filter(Boolean).join(". "));
  }

  /** The floor, to select; where there is none, a button that adds one. */
  private showGround(): void {
    const { document: scene, selection } = this.parts;
    const floor = [...scene.entities.values()].find((entity) => entity.shape?.type === "plane" || entity.category === "floor" || entity.category === "ground" || /^(floor|ground)\b/i.test(entity.name ?? ""));
    const shown = floor ? `${floor.index} ${nameOf(floor)}` : "";
    if (this.ground.dataset["shown"] === shown) return;
    this.ground.dataset["shown"] = shown;
    this.ground.replaceChildren(
      floor
        ? element("button", { class: "chip", title: "Select it", "data-testid": "ground", onclick: () => selection.set([floor.index]) }, nameOf(floor))
        : element("button", { class: "chip", "data-testid": "add-ground", onclick: () => this.addGround() }, "Add a floor"),
    );
  }

  private addGround(): void {
    const [width, depth] = [30, 0.5];
    const entity = { name: "Floor", category: "floor", shape: { type: "box" as const, half_extents: [width / 2, depth / 2, width / 2] as Vector }, attributes: { kind: "static" }, pose: { position: [0, -depth / 2, 0] as Vector } };
    void this.parts.server.command("entity.add", { entity });
  }
}

function labelled(label: string, field: HTMLElement, help: string): HTMLElement {
  return element("div", { class: "attribute" }, element("span", { class: "attribute-label", title: help }, label), field);
}

function count(number: number, one: string, many: string): string {
  return `${number} ${number === 1 ? one : many}`;
}
