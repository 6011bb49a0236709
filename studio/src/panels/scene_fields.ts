// SPDX-License-Identifier: MIT
import { DEFAULT_SETTINGS, type SceneSettings, type Vector } from "../connection/scene_types";
import { withTyped } from "../document/components";
import { nameOf } from "../document/scene_document";
import type { Parts } from "../parts";
import { element, setText, show } from "./element";
import { type Components, type Field, numberField, textField, truthField, vectorField } from "./fields";
import { foldingGroup } from "./folding";
import { daylightGroup } from "./look_fields";
import { t, translateServerText } from "../language";

/** Free fall at the surface, m/s², and density of the air there, kg/m³ (NASA, Planetary Fact Sheets). */
const PLACES: readonly { id: string; name: string; gravity: number; air: number }[] = [
  { id: "Earth", name: t("Earth"), gravity: 9.81, air: 1.2 },
  { id: "Moon", name: t("Moon"), gravity: 1.62, air: 0 },
  { id: "Mars", name: t("Mars"), gravity: 3.71, air: 0.02 },
  { id: "No weight", name: t("No weight"), gravity: 0, air: 1.2 },
];

type Setting = keyof SceneSettings;

/** The world of the scene, shown while nothing is selected: where it is, its air, its ground, and, folded, how exactly it is computed. */
export class SceneFields {
  readonly root: HTMLElement;
  private readonly rows = new Map<Setting, { root: HTMLElement; field: Field<never> }>();
  private readonly title = textField(t("Title"), (title) => this.set({ title }));
  private readonly places = PLACES.map((place) => ({
    ...place,
    button: element("button", { class: "chip", title: t("Falls with {{gravity}} m/s², air of {{air}} kg/m³", { gravity: place.gravity, air: place.air }), "data-testid": `place-${place.id}`, onclick: () => this.goTo(place) }, place.name),
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
      { class: "entity", "aria-label": t("Scene"), "data-testid": "scene-fields" },
      element("h2", {}, t("Scene")),
      this.contents,
      foldingGroup(
        preferences,
        "scene.world",
        t("World"),
        true,
        labelled(t("Title"), this.title.root, t("What the scene is called")),
        labelled(t("Where it is"), element("span", { class: "field preset-chips" }, ...this.places.map(({ button }) => button)), t("Sets weight and air as they are there")),
        vector("gravity", t("Gravity"), "m/s²", t("How fast things begin to fall, and where to")),
        labelled(t("Ground"), this.ground, t("What everything stands on")),
      ),
      foldingGroup(
        preferences,
        "scene.air",
        t("Air and wind"),
        true,
        vector("wind", t("Wind"), "m/s", t("Where the air moves to, and how fast: it moves cloth, and slows what flies")),
        number("gustiness", t("Gustiness"), "", t("How much the wind changes: 0 is steady, 0.2 a usual wind, 1 gusts as strong as the wind")),
        number("gust_time", t("A gust lasts"), "s", t("How long the wind is stronger or weaker")),
        number("air_density", t("Air density"), "kg/m³", t("Thick air slows more: 1.2 on Earth, none on the Moon")),
      ),
      foldingGroup(
        preferences,
        "scene.accuracy",
        t("Simulation accuracy"),
        false,
        element("p", { class: "note" }, t("More exact is slower. What is set here suits nearly all scenes.")),
        number("time_step", t("Time step"), "s", t("Time between two moments that are computed: shorter is more exact, for fast and small things")),
        number("substeps", t("Parts of a step"), "", t("Each moment is computed in so many parts: more makes stacks, joints and ropes stiffer"), 1),
        truth("shock_propagation", t("Firm stacks"), t("Computes stacks from the ground up, so that high ones stand")),
        truth("sleeping", t("Rest when quiet"), t("What lies still is not computed until it is touched")),
        number("time_to_sleep", t("Rests after"), "s", t("How long a thing must lie still before it rests")),
        number("max_linear_speed", t("Fastest speed"), "m/s", t("Faster things are slowed to this, and you are told")),
        number("max_angular_speed", t("Fastest spin"), "rad/s", t("The same for turning")),
      ),
      this.daylight.root,
      element("p", { class: "note" }, t("Select an entity, or click on a model, to see what it is made of. Drag models in from the left; they land on what is under the pointer.")),
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
    const parts = [t("{{count}} entities", { count: scene.entities.size }), t("{{count}} joints", { count: scene.joints.size }), t("{{count}} actions", { count: scene.actions.size })];
    setText(this.contents, [parts.join(t(", ")), translateServerText(scene.description)].filter(Boolean).join(t(". ")));
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
        ? element("button", { class: "chip", title: t("Select it"), "data-testid": "ground", onclick: () => selection.set([floor.index]) }, nameOf(floor))
        : element("button", { class: "chip", "data-testid": "add-ground", onclick: () => this.addGround() }, t("Add a floor")),
    );
  }

  private addGround(): void {
    const [width, depth] = [30, 0.5];
    const entity = { name: t("Floor"), category: "floor", shape: { type: "box" as const, half_extents: [width / 2, depth / 2, width / 2] as Vector }, attributes: { kind: "static" }, pose: { position: [0, -depth / 2, 0] as Vector } };
    void this.parts.server.command("entity.add", { entity });
  }
}

function labelled(label: string, field: HTMLElement, help: string): HTMLElement {
  return element("div", { class: "attribute" }, element("span", { class: "attribute-label", title: help }, label), field);
}
