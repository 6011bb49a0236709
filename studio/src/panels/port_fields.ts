// SPDX-License-Identifier: MIT
import { withTyped } from "../document/components";
import { nameOf } from "../document/scene_document";
import { drainOf, isLiquid, tapOf } from "../document/ports";
import type { Drain, Entity, Tap, Vector } from "../connection/scene_types";
import type { Parts } from "../parts";
import { element, show } from "./element";
import { numberField, truthField, vectorField } from "./fields";
import { t } from "../language";

/** In a large scene only so many liquids are offered. */
const MOST_LIQUIDS = 300;

function row(label: string, field: HTMLElement, help: string): HTMLElement {
  return element("div", { class: "attribute" }, element("span", { class: "attribute-label", title: help }, label), field);
}

/** The value that all have, or null. */
function common<Value>(entities: readonly Entity[], read: (entity: Entity) => Value): Value | null {
  const first = read(entities[0]!);
  return entities.every((entity) => read(entity) === first) ? first : null;
}

/** What comes from the selected rigid things and goes into them, and whether selected liquids start empty. */
export class PortFields {
  readonly root: HTMLElement;
  private readonly rate = numberField(t("Flow"), "l/min", (litres_per_minute) => this.changeTaps(() => ({ litres_per_minute })), { step: 1 });
  private readonly tapOpen = truthField(t("Tap open"), (open) => this.changeTaps(() => ({ open })));
  private readonly mouth = numberField(t("Radius of the mouth"), "m", (radius) => this.changeTaps(() => ({ radius })), { step: 0.001 });
  private readonly speed = numberField(t("Speed"), "m/s", (speed) => this.changeTaps(() => ({ speed })), { step: 0.1 });
  private readonly place = vectorField([t("Mouth x"), t("Mouth y"), t("Mouth z")], "m", (typed) => this.changeTaps(({ position }) => ({ position: withTyped(position, typed) as Vector })), 0.01);
  private readonly liquid = element("select", { "aria-label": t("Liquid"), "data-testid": "tap-liquid", onchange: () => this.changeTaps(() => ({ liquid: Number(this.liquid.value) })) });
  private readonly hole = numberField(t("Radius of the drain"), "m", (radius) => this.changeDrains(() => ({ radius })), { step: 0.005 });
  private readonly drainOpen = truthField(t("Drain open"), (open) => this.changeDrains(() => ({ open })));
  private readonly startsEmpty = truthField(t("Starts empty"), (starts_empty) => this.changeEach(() => ({ starts_empty })));
  private readonly tapRows = [
    row(t("Tap open"), this.tapOpen.root, t("Also while it plays")),
    row(t("Radius of the mouth"), this.mouth.root, t("The liquid leaves a disc along the arrow")),
    row(t("Speed"), this.speed.root, t("0: as fast as the flow fills the mouth. A higher one makes drops, as a shower")),
    row(t("Mouth"), this.place.root, t("In the thing's own frame, outside of solids")),
    row(t("Liquid"), element("span", { class: "field" }, this.liquid), t("Which liquid gains what comes")),
  ];
  private readonly drainRow = row(t("Drain open"), this.drainOpen.root, t("Also while it plays"));
  private readonly rigidRows = [
    row(t("Flow"), this.rate.root, t("How much comes from it; 0: it is no tap. A bath tap gives 20 l/min")),
    ...this.tapRows,
    row(t("Radius of the drain"), this.hole.root, t("Takes the drops that come so near; 0: it is no drain")),
    this.drainRow,
  ];
  private readonly emptyRow = row(t("Starts empty"), this.startsEmpty.root, t("It begins without a drop, for a tap to fill"));
  private readonly group = element("details", { class: "group", "data-testid": "port-group" }, element("summary", {}, t("Tap and drain")), ...this.rigidRows, this.emptyRow);

  constructor(private readonly parts: Pick<Parts, "server" | "document" | "selection" | "entities" | "view">) {
    this.root = element("section", { class: "entity", "data-testid": "port-fields", "aria-label": t("Tap and drain") }, this.group);
    parts.selection.changed.on(() => {
      this.update();
      this.group.open = this.entities().some((entity) => tapOf(entity).litres_per_minute > 0 || drainOf(entity).radius > 0 || entity.starts_empty);
    });
    parts.document.changed.on(() => this.update());
    parts.entities.pointed.on(() => this.update());
    this.update();
  }

  private entities(): Entity[] {
    return this.parts.selection.indices.flatMap((index) => this.parts.document.entity(index) ?? []);
  }

  private update(): void {
    const { entities: drawn, document, selection, view } = this.parts;
    const entities = this.entities();
    view.ports.show(selection.indices);
    view.invalidate();
    const areLiquids = entities.length > 0 && entities.every((entity) => isLiquid(entity, drawn));
    const areRigid = entities.length > 0 && entities.every((entity) => !isLiquid(entity, drawn) && !drawn.clouds.of(entity.index) && !drawn.softs.has(entity.index));
    show(this.root, areLiquids || areRigid);
    show(this.emptyRow, areLiquids);
    for (const each of this.rigidRows) show(each, areRigid);
    if (areLiquids) this.startsEmpty.set(common(entities, ({ starts_empty }) => starts_empty ?? false));
    if (!areRigid) return;
    const taps = entities.map(tapOf);
    const areTaps = taps.every(({ litres_per_minute }) => litres_per_minute > 0);
    for (const each of this.tapRows) show(each, areTaps);
    show(this.drainRow, entities.every((entity) => drainOf(entity).radius > 0));
    this.rate.set(common(entities, (entity) => tapOf(entity).litres_per_minute));
    this.tapOpen.set(common(entities, (entity) => tapOf(entity).open));
    this.mouth.set(common(entities, (entity) => tapOf(entity).radius));
    this.speed.set(common(entities, (entity) => tapOf(entity).speed));
    this.place.set(taps[0]!.position);
    this.hole.set(common(entities, (entity) => drainOf(entity).radius));
    this.drainOpen.set(common(entities, (entity) => drainOf(entity).open));
    const liquids = [...document.entities.values()].filter((entity) => isLiquid(entity, drawn)).slice(0, MOST_LIQUIDS);
    this.liquid.replaceChildren(
      element("option", { value: "0" }, t("the first one")),
      ...liquids.map((each) => element("option", { value: String(each.index) }, nameOf(each))),
    );
    this.liquid.value = String(common(entities, (entity) => tapOf(entity).liquid) ?? "");
  }

  private changeTaps(changed: (tap: Tap) => Partial<Tap>): void {
    this.changeEach((entity) => ({ tap: { ...tapOf(entity), ...changed(tapOf(entity)) } }));
  }

  private changeDrains(changed: (drain: Drain) => Partial<Drain>): void {
    this.changeEach((entity) => ({ drain: { ...drainOf(entity), ...changed(drainOf(entity)) } }));
  }

  private changeEach(changed: (entity: Entity) => Partial<Entity>): void {
    // One undo takes back the change of all entities.
    const merge = `ports-${Date.now()}`;
    for (const entity of this.entities()) void this.parts.server.command("entity.update", { index: entity.index, entity: changed(entity), merge });
  }
}
