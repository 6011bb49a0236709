// SPDX-License-Identifier: MIT
import { Color } from "three";
import type { NewEntity } from "../connection/messages";
import { commonComponents, withTyped } from "../document/components";
import { outermostGroup } from "../document/groups";
import { nameOf } from "../document/scene_document";
import type { Entity, Shape, ShapeOfLengths, Vector } from "../connection/scene_types";
import type { Parts } from "../parts";
import { icon } from "../tools/icons";
import { allLocked, toggleLock, withoutLocked } from "../tools/locks";
import { presentPose, rotationOfDegrees } from "../tools/typed_poses";
import { colorOf } from "../view/entity_view";
import { fieldsOf, isOfLengths, shownLength, withShownLength } from "../view/shapes_of_lengths";
import { element, show } from "./element";
import { foldingGroup } from "./folding";
import { type Field, numberField, textField, truthField, vectorField } from "./fields";
import { modelCard } from "./model_card";
import { t } from "../language";

const LIVE_EVERY_MS = 200;

type Row = { root: HTMLElement; update(entities: Entity[]): void };

/** Name, pose, size and start of the selected entities, which do not depend on their material. */
export class EntityFields {
  /** Name, lock and model; what matters most of its values comes between this and the fields. */
  readonly head = element("section", { class: "entity", "data-testid": "entity-head", "aria-label": t("Entity") });
  readonly root = element("section", { class: "entity", "data-testid": "entity-fields", "aria-label": t("Place and start") });
  private rows: Row[] = [];
  private lastLive = 0;

  constructor(private readonly parts: Pick<Parts, "preferences" | "server" | "notices" | "document" | "playback" | "selection" | "models" | "entities" | "view">) {
    for (const root of [this.head, this.root]) show(root, false);
    parts.selection.changed.on(() => this.rebuild());
    parts.document.changed.on(() => this.update());
    parts.entities.loaded.on(() => this.update());
    parts.view.beforeFrame.on((now) => {
      if (now - this.lastLive < LIVE_EVERY_MS) return;
      this.lastLive = now;
      this.update();
    });
  }

  private entities(): Entity[] {
    return this.parts.selection.indices.flatMap((index) => this.parts.document.entity(index) ?? []);
  }

  private rebuild(): void {
    const entities = this.entities();
    for (const root of [this.head, this.root]) show(root, entities.length > 0);
    if (entities.length === 0) return;
    const single = entities.length === 1 ? entities[0]! : null;
    const shown: Row[] = [...this.poseRows()];
    if (single?.shape) shown.push(...this.shapeRows(single.shape));
    if (entities.every((entity) => entity.model)) shown.push(this.scaleRow());
    if (entities.every((entity) => entity.shape)) shown.push(this.colorRow());
    const start = this.startRows();
    this.rows = [...(single ? [this.nameRow()] : []), ...shown, ...start];
    const card = single?.model ? modelCard(this.parts, single.model) : null;
    const title = single ? this.rows[0]!.root : element("h2", { "data-testid": "selection-count" }, t("{{count}} entities", { count: entities.length }));
    const padlock = this.padlock();
    const form = this.formLine();
    this.rows.push(padlock, form);
    const group = single ? "" : outermostGroup(entities[0]!.group);
    const isGroup = group !== "" && entities.every((entity) => outermostGroup(entity.group) === group);
    const hint = isGroup ? element("p", { class: "note", "data-testid": "group-hint" }, t("Group “{{group}}”. Alt and a click select one of them alone.", { group })) : null;
    this.head.replaceChildren(...[element("div", { class: "entity-head" }, title, padlock.root), hint, card, form.root].filter((each) => each !== null));
    this.root.replaceChildren(
      foldingGroup(this.parts.preferences, "entity.place", t("Place and size"), true, ...shown.map((row) => row.root)),
      foldingGroup(this.parts.preferences, "entity.start", t("Start and forces"), false, ...start.map((row) => row.root)),
    );
    this.update();
  }

  private update(): void {
    const entities = this.entities();
    if (entities.length > 0) for (const row of this.rows) row.update(entities);
  }

  private padlock(): Row {
    const { parts } = this;
    const button = element("button", { class: "plain padlock", "data-testid": "entity-lock", onclick: () => toggleLock(parts, parts.selection.indices) });
    let shown: boolean | null = null;
    return {
      root: button,
      update: () => {
        const locked = allLocked(parts, parts.selection.indices);
        if (locked === shown) return;
        shown = locked;
        button.replaceChildren(icon(locked ? "lock" : "unlock"));
        button.setAttribute("aria-pressed", String(locked));
        button.setAttribute("aria-label", locked ? t("Unlock") : t("Lock"));
        button.title = locked ? t("Locked: keeps its place, size and existence. Click to unlock (L)") : t("Lock it where it is (L)");
      },
    };
  }

  private nameRow(): Row {
    const field = textField(t("Name"), (name) => this.change({ name }));
    field.root.classList.add("name-field");
    field.root.querySelector("input")!.dataset["testid"] = "entity-name";
    return { root: field.root, update: ([entity]) => field.set(nameOf(entity!)) };
  }

  private poseRows(): Row[] {
    const only = (at: number, value: (own: number) => number) => (own: readonly number[]) => own.map((part, each) => (each === at ? value(part) : part));
    const position = vectorField([t("Position x"), t("Position y"), t("Position z")], "m", (typed) => this.move("position", (own) => withTyped(own, typed)), 0.01, (at, change) => this.move("position", only(at, change)));
    const rotation = vectorField([t("Rotation x"), t("Rotation y"), t("Rotation z")], "°", (typed) => this.move("degrees", (own) => withTyped(own, typed)), 1, (at, change) => this.move("degrees", only(at, change)));
    const update = (entities: Entity[]): void => {
      const poses = entities.map((entity) => presentPose(this.parts, entity));
      position.set(commonComponents(poses.map((pose) => pose.position.map((length) => rounded(length, 1e4)))));
      rotation.set(commonComponents(poses.map((pose) => pose.degrees.map((angle) => rounded(angle, 100)))));
    };
    return [
      { root: row(t("Position"), position.root), update },
      { root: row(t("Rotation"), rotation.root), update: () => {} },
    ];
  }

  /** Changes the poses of all that are not locked. */
  private move(part: "position" | "degrees", changed: (own: readonly number[]) => number[]): void {
    const { parts } = this;
    const poses = withoutLocked(parts, parts.selection.indices).flatMap((index) => {
      const entity = parts.document.entity(index);
      if (!entity) return [];
      const next = changed(presentPose(parts, entity)[part]);
      return [part === "position" ? { index, position: next as Vector } : { index, rotation: rotationOfDegrees(next) }];
    });
    if (poses.length > 0) void parts.server.command("entity.transform", { poses });
  }

  /** The lengths of a primitive, as full widths and heights. */
  private shapeRows(shape: Shape): Row[] {
    if (!isOfLengths(shape)) return [];
    return fieldsOf(shape).map((length) => {
      const present = () => (this.entities()[0]?.shape ?? shape) as ShapeOfLengths;
      const put = (shown: number | Vector) => this.resize(() => ({ shape: withShownLength(present(), length, shown) }));
      const shown = (entity: Entity) => shownLength(entity.shape as ShapeOfLengths, length);
      if (length.each) {
        const own = () => shownLength(present(), length) as Vector;
        const field = vectorField(length.each, "m", (typed) => put(withTyped(own(), typed) as Vector), 0.01);
        return { root: row(length.label, field.root), update: ([entity]) => field.set(shown(entity!) as Vector) };
      }
      const field = numberField(length.label, "m", put, { step: 0.01 });
      return { root: row(length.label, field.root), update: ([entity]) => field.set(shown(entity!) as number) };
    });
  }

  private scaleRow(): Row {
    const field = numberField(t("Scale"), "", (scale) => this.resize(() => ({ scale })), { step: 0.05, each: (change) => this.resize((entity) => ({ scale: change(entity.scale ?? 1) })) });
    return { root: row(t("Scale"), field.root), update: (entities) => field.set(common(entities, (entity) => entity.scale ?? 1)) };
  }

  /** Shown where a run has left its form: folds, dents, heaps, puddles. */
  private formLine(): Row {
    const kept = () => this.entities().filter((entity) => entity.kept);
    const forget = element("button", { "data-testid": "forget-form", title: t("As modelled again, where it lies"), onclick: () => this.changeEach(kept(), () => ({ kept: null })) }, t("Forget"));
    const root = element("div", { class: "form-line", "data-testid": "kept-form" }, element("span", {}, t("Form kept from a run")), forget);
    return { root, update: () => show(root, kept().length > 0) };
  }

  private colorRow(): Row {
    const input = element("input", { type: "color", "aria-label": t("Colour") });
    input.addEventListener("change", () => this.change({ color: new Color(input.value).toArray() as Vector }));
    return {
      root: row(t("Colour"), element("span", { class: "field" }, input)),
      update: ([entity]) => {
        if (document.activeElement !== input) input.value = `#${colorOf(entity!).getHexString()}`;
      },
    };
  }

  private startRows(): Row[] {
    const vector = (label: string, unit: string, name: "linear_velocity" | "angular_velocity" | "force" | "torque"): Row => {
      const own = (entity: Entity): Vector => entity[name] ?? [0, 0, 0];
      const field = vectorField(
        [`${label} x`, `${label} y`, `${label} z`],
        unit,
        (typed) => this.changeEach(this.entities(), (entity) => ({ [name]: withTyped(own(entity), typed) })),
        undefined,
        (at, change) => this.changeEach(this.entities(), (entity) => ({ [name]: own(entity).map((part, each) => (each === at ? change(part) : part)) })),
      );
      const root = row(label, field.root);
      return {
        root,
        update: (entities) => {
          field.set(commonComponents(entities.map(own)));
          markChanged(root, entities.some((entity) => own(entity).some((part) => part !== 0)));
        },
      };
    };
    const truth = (label: string, name: "enabled" | "start_asleep" | "continuous", standard: boolean): Row => {
      const field = truthField(label, (value) => this.change({ [name]: value }));
      const shown = bound(label, field, (entity) => entity[name] ?? standard);
      return { root: shown.root, update: (entities) => (shown.update(entities), markChanged(shown.root, entities.some((entity) => (entity[name] ?? standard) !== standard))) };
    };
    return [
      vector(t("Velocity"), "m/s", "linear_velocity"),
      vector(t("Spin"), "rad/s", "angular_velocity"),
      vector(t("Force"), "N", "force"),
      vector(t("Torque"), "N m", "torque"),
      truth(t("In the world"), "enabled", true),
      truth(t("Starts asleep"), "start_asleep", false),
      truth(t("Fast: never tunnels"), "continuous", false),
    ];
  }

  private change(entity: NewEntity): void {
    this.changeEach(this.entities(), () => entity);
  }

  /** Changes the size, which locked entities keep. */
  private resize(changed: (entity: Entity) => NewEntity): void {
    const free = new Set(withoutLocked(this.parts, this.parts.selection.indices));
    this.changeEach(this.entities().filter(({ index }) => free.has(index)), changed);
  }

  private changeEach(entities: Entity[], changed: (entity: Entity) => NewEntity): void {
    // One undo takes back the change of all entities.
    const merge = `fields-${Date.now()}`;
    for (const entity of entities) void this.parts.server.command("entity.update", { index: entity.index, entity: changed(entity), merge });
  }
}

function row(label: string, field: HTMLElement): HTMLElement {
  return element("div", { class: "attribute" }, element("span", { class: "attribute-label" }, label), field);
}

function bound<Value>(label: string, field: Field<Value>, read: (entity: Entity) => Value): Row {
  return { root: row(label, field.root), update: (entities) => field.set(common(entities, read)) };
}

/** For “Only what I changed”. */
function markChanged(root: HTMLElement, changed: boolean): void {
  if (root.dataset["changed"] !== String(changed)) root.dataset["changed"] = String(changed);
}

/** The value that all entities have, or null. */
function common<Value>(entities: Entity[], read: (entity: Entity) => Value): Value | null {
  const first = read(entities[0]!);
  const text = JSON.stringify(first);
  return entities.every((entity) => JSON.stringify(read(entity)) === text) ? first : null;
}

/** Rounded to so many parts of one; without a negative zero. */
function rounded(value: number, parts: number): number {
  return Math.round(value * parts) / parts + 0;
}
