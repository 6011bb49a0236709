// SPDX-License-Identifier: MIT
import type { SimulationMesh } from "../connection/messages";
import { heldNodes, nearestNode, pinsAt, PLACE_LABELS, placesOf } from "../document/pins";
import { nameOf } from "../document/scene_document";
import type { Entity, Pin, Vector } from "../connection/scene_types";
import type { Parts } from "../parts";
import { element, setText, show } from "./element";
import { t } from "../language";

const WORLD = "";
/** In a large scene only so many entities are offered to pin to. */
const MOST_HOLDERS = 300;

/** The pins of the selected cloth, rope or soft thing, and the entities that hold them. */
export class PinFields {
  readonly root: HTMLElement;
  private readonly buttons = element("div", { class: "pin-buttons" });
  private readonly said = element("p", { class: "note", "data-testid": "pin-count" });
  private readonly holder = element("select", { "aria-label": t("Held by"), "data-testid": "pin-holder", onchange: () => this.holdBy() });
  private readonly clamped = element("input", { type: "checkbox", "aria-label": t("Clamped"), "data-testid": "pin-clamped", onchange: () => this.clamp() });
  private readonly clampedRow = element("label", { class: "attribute" }, element("span", { class: "attribute-label", title: t("Holds the rope's direction and twist, too") }, t("Clamped")), this.clamped);
  private index = 0;
  private mesh: SimulationMesh | null = null;
  /** The next click on the entity pins it there. */
  private picking = false;

  constructor(private readonly parts: Pick<Parts, "server" | "document" | "playback" | "selection" | "entities" | "view">) {
    const group = element(
      "details",
      { class: "group", open: true },
      element("summary", {}, t("Pins")),
      this.said,
      this.buttons,
      element("div", { class: "attribute" }, element("span", { class: "attribute-label", title: t("What the pins are attached to") }, t("Held by")), this.holder),
      this.clampedRow,
    );
    this.root = element("section", { class: "entity", "data-testid": "pins", "aria-label": t("Pins") }, group);
    show(this.root, false);
    for (const signal of [parts.selection.changed, parts.document.changed, parts.entities.loaded, parts.playback.changed]) signal.on(() => void this.follow());
    parts.entities.pointed.on(() => void this.follow());
    parts.view.canvas.addEventListener("pointerdown", (event) => this.pinHere(event), { capture: true });
    addEventListener("keydown", (event) => event.key === "Escape" && this.pick(false));
  }

  private get entity(): Entity | null {
    const { selection, document } = this.parts;
    return selection.indices.length === 1 ? (document.entities.get(selection.indices[0]!) ?? null) : null;
  }

  /** Shows the selected entity, if it is deformable. */
  private async follow(): Promise<void> {
    const { entity, parts } = this;
    const index = entity && parts.entities.softs.has(entity.index) ? entity.index : 0;
    const isOther = index !== this.index;
    const places = parts.entities.softs.placesOf(index);
    if (isOther || places?.length !== this.mesh?.nodes.length) {
      if (isOther) this.pick(false);
      this.index = index;
      this.mesh = null;
      const told = index ? await parts.server.command("entity.simulation_mesh", { index }) : undefined;
      // The selection may have changed while the answer was on its way.
      if (this.index !== index) return;
      this.mesh = told?.mesh ?? null;
      this.offer();
    }
    this.update();
  }

  private offer(): void {
    const { mesh } = this;
    const button = (text: string, title: string, name: string, run: () => void) => element("button", { title, "data-testid": `pin-${name}`, onclick: run }, text);
    this.buttons.replaceChildren(
      ...(mesh ? placesOf(mesh).map((place) => button(PLACE_LABELS[place], t("Pin it there"), place, () => this.add((entity) => pinsAt(place, mesh, entity)))) : []),
      button(t("A place…"), t("Then click on the point of the thing to pin"), "pick", () => this.pick(!this.picking)),
      button(t("Remove all"), t("Nothing holds it any more"), "none", () => this.put([])),
    );
  }

  private update(): void {
    const { entity, mesh, parts } = this;
    show(this.root, this.index !== 0);
    const pins = (entity && this.index && entity.pins) || [];
    parts.view.pins.show(this.index, mesh && pins.length > 0 ? heldNodes(pins, mesh.nodes) : []);
    parts.view.invalidate();
    if (!this.index) return;
    setText(this.said, this.picking ? t("Click on the point to pin; Escape ends that.") : pins.length === 0 ? t("Nothing holds it.") : t("{{count}} places are held, shown as dots.", { count: pins.length }));
    const holders = [...parts.document.entities.values()].filter(({ index }) => index !== this.index && !parts.entities.clouds.of(index));
    this.holder.replaceChildren(
      element("option", { value: WORLD }, t("the world")),
      ...holders.slice(0, MOST_HOLDERS).map((each) => element("option", { value: String(each.index) }, nameOf(each))),
    );
    this.holder.value = pins[0]?.to === undefined ? WORLD : String(pins[0].to);
    show(this.clampedRow, mesh !== null && !mesh.triangles && !mesh.tetrahedra);
    this.clamped.checked = pins.length > 0 && pins.every(({ clamped }) => clamped);
  }

  private get to(): Pick<Pin, "to"> {
    return this.holder.value === WORLD ? {} : { to: Number(this.holder.value) };
  }

  private add(make: (entity: Entity) => Pin[]): void {
    const { entity } = this;
    if (!entity) return;
    const known = new Set((entity.pins ?? []).map(({ position }) => JSON.stringify(position)));
    const added = make(entity).filter(({ position }) => !known.has(JSON.stringify(position)));
    this.put([...(entity.pins ?? []), ...added.map((pin) => ({ ...pin, ...this.to, ...(this.clamped.checked && !this.clampedRow.hidden && { clamped: true }) }))]);
  }

  private put(pins: Pin[]): void {
    this.pick(false);
    void this.parts.server.command("entity.update", { index: this.index, entity: { pins } });
  }

  private holdBy(): void {
    const { entity } = this;
    if (!entity?.pins?.length) return;
    const { to } = this;
    this.put(entity.pins.map(({ to: _, ...pin }) => ({ ...pin, ...to })));
  }

  private clamp(): void {
    const { entity } = this;
    const { checked } = this.clamped;
    if (entity?.pins?.length) this.put(entity.pins.map(({ clamped: _, ...pin }) => ({ ...pin, ...(checked && { clamped: true }) })));
  }

  private pick(picking: boolean): void {
    if (this.picking === picking) return;
    this.picking = picking;
    this.parts.view.canvas.style.cursor = picking ? "crosshair" : "";
    this.update();
  }

  private pinHere(event: PointerEvent): void {
    if (!this.picking || event.button !== 0 || !this.mesh) return;
    event.stopImmediatePropagation();
    const places = this.parts.entities.softs.placesOf(this.index);
    const hit = this.parts.view.pick(event.clientX, event.clientY);
    if (!places || hit?.index !== this.index) {
      setText(this.said, t("Click on the selected thing itself, or press Escape."));
      return;
    }
    const node = nearestNode(places, hit.point);
    const position = this.mesh.nodes.slice(3 * node, 3 * node + 3) as Vector;
    this.add(() => [{ position }]);
  }
}
