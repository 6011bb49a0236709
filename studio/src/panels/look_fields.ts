// SPDX-License-Identifier: MIT
import { FINISHES, type Entity, type Finish, type Light } from "../connection/scene_types";
import type { Parts } from "../parts";
import { isOn } from "../view/lamps";
import { element, show } from "./element";
import { numberField, truthField, wordField } from "./fields";
import { t } from "../language";

/** What a lamp gives that is switched on for the first time. */
const USUAL_LIGHT: Light = { lumen: 800, kelvin: 2700, on: true };
const NO_LIGHT: Light = { lumen: 0, kelvin: 2700, on: true };

function row(label: string, field: HTMLElement, help: string): HTMLElement {
  return element("div", { class: "attribute" }, element("span", { class: "attribute-label", title: help }, label), field);
}

/** The value that all have, or null. */
function common<Value extends string | number | boolean>(entities: readonly Entity[], read: (entity: Entity) => Value): Value | null {
  const first = read(entities[0]!);
  return entities.every((entity) => read(entity) === first) ? first : null;
}

/** Finish and light of the selected entities. */
export class LookFields {
  readonly root: HTMLElement;
  private readonly finish = wordField(t("Finish"), FINISHES, (finish) => this.changeEach(() => ({ finish: finish as Finish })));
  private readonly on = truthField(t("Light", { context: "lamp" }), (on) => this.changeEach(({ light = NO_LIGHT }) => ({ light: on && light.lumen === 0 ? USUAL_LIGHT : { ...light, on } })));
  private readonly lumen = numberField(t("Brightness"), "lm", (lumen) => this.changeEach(({ light = NO_LIGHT }) => ({ light: { ...light, lumen } })), { step: 50 });
  private readonly kelvin = numberField(t("Colour temperature"), "K", (kelvin) => this.changeEach(({ light = NO_LIGHT }) => ({ light: { ...light, kelvin } })), { step: 100 });
  private readonly finishRow = row(t("Finish"), this.finish.root, t("What its surface looks like, over its colour"));
  private readonly lumenRow = row(t("Brightness"), this.lumen.root, t("800 lm is a usual lamp, 400 one beside a bed"));
  private readonly kelvinRow = row(t("Temperature"), this.kelvin.root, t("2700 K is warm, 4000 K neutral, 6500 K daylight"));

  constructor(private readonly parts: Pick<Parts, "server" | "document" | "selection">) {
    this.root = element(
      "section",
      { class: "entity", "data-testid": "look-fields", "aria-label": t("Look") },
      element(
        "details",
        { class: "group", open: true },
        element("summary", {}, t("Look")),
        this.finishRow,
        row(t("Light", { context: "lamp" }), this.on.root, t("Lights what is around it")),
        this.lumenRow,
        this.kelvinRow,
      ),
    );
    parts.selection.changed.on(() => this.update());
    parts.document.changed.on(() => this.update());
    this.update();
  }

  private entities(): Entity[] {
    return this.parts.selection.indices.flatMap((index) => this.parts.document.entity(index) ?? []);
  }

  private update(): void {
    const entities = this.entities();
    show(this.root, entities.length > 0);
    if (entities.length === 0) return;
    show(
      this.finishRow,
      entities.every(({ shape }) => shape),
    );
    this.finish.set(common(entities, ({ finish }) => finish ?? "plain"));
    this.on.set(common(entities, ({ light }) => isOn(light)));
    const areLamps = entities.every(({ light }) => (light?.lumen ?? 0) > 0);
    show(this.lumenRow, areLamps);
    show(this.kelvinRow, areLamps);
    this.lumen.set(common(entities, ({ light }) => light?.lumen ?? 0));
    this.kelvin.set(common(entities, ({ light }) => light?.kelvin ?? NO_LIGHT.kelvin));
  }

  private changeEach(changed: (entity: Entity) => Partial<Entity>): void {
    // One undo takes back the change of all entities.
    const merge = `look-${Date.now()}`;
    for (const entity of this.entities()) void this.parts.server.command("entity.update", { index: entity.index, entity: changed(entity), merge });
  }
}

/** Sky and time of day, for the scene's own settings. */
export function daylightGroup(parts: Pick<Parts, "server" | "document">): { root: HTMLElement; update(): void } {
  const { document: scene, server } = parts;
  const sky = truthField(t("Sky"), (on) => void server.command("scene.settings", { sky: on }));
  const slider = element("input", { type: "range", min: "0", max: "24", step: "0.25", "aria-label": t("Time of day"), "data-testid": "time-of-day" });
  const told = element("span", { class: "unit" });
  let merge = "";
  const tell = () => {
    const minutes = Math.round(60 * Number(slider.value));
    told.textContent = `${Math.floor(minutes / 60)}:${String(minutes % 60).padStart(2, "0")}`;
  };
  slider.addEventListener("input", () => {
    tell();
    // A whole drag is one step of undo.
    merge ||= `time-of-day-${Date.now()}`;
    void server.command("scene.settings", { time_of_day: Number(slider.value), merge });
  });
  slider.addEventListener("change", () => (merge = ""));
  const hour = row(t("Time of day"), element("span", { class: "field" }, slider, told), t("Where the sun stands: it rises at 6 and sets at 18"));
  const root = element("details", { class: "group", open: true }, element("summary", {}, t("Light")), row(t("Sky"), sky.root, t("Sun and sky in place of the Studio's plain light")), hour);
  return {
    root,
    update() {
      sky.set(scene.sky);
      show(hour, scene.sky);
      if (merge) return;
      slider.value = String(scene.timeOfDay);
      tell();
    },
  };
}
