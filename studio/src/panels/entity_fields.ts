// SPDX-License-Identifier: MIT
import { Color, Euler, Matrix4, Quaternion, Vector3 } from "three";
import type { NewEntity, PoseEdit } from "../connection/messages";
import { nameOf } from "../document/scene_document";
import type { Entity, Shape, ShapeOfLengths, Vector } from "../connection/scene_types";
import type { Parts } from "../parts";
import { colorOf } from "../view/entity_view";
import { fieldsOf, isOfLengths, shownLength, withShownLength } from "../view/shapes_of_lengths";
import { element, show } from "./element";
import { type Field, numberField, textField, truthField, vectorField } from "./fields";
import { modelCard } from "./model_card";

const DEGREE = Math.PI / 180;
const LIVE_EVERY_MS = 200;

type Row = { root: HTMLElement; update(entities: Entity[]): void };

/** Name, pose, size and start of the selected entities, which do not depend on their material. */
export class EntityFields {
  readonly root = element("section", { class: "entity", "data-testid": "entity-fields", "aria-label": "Entity" });
  private rows: Row[] = [];
  private lastLive = 0;

  constructor(private readonly parts: Pick<Parts, "server" | "document" | "selection" | "models" | "entities" | "view">) {
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
    show(this.root, entities.length > 0);
    if (entities.length === 0) return;
    const single = entities.length === 1 ? entities[0]! : null;
    const shown: Row[] = [...this.poseRows()];
    if (single?.shape) shown.push(...this.shapeRows(single.shape));
    if (entities.every((entity) => entity.model)) shown.push(this.scaleRow());
    if (entities.every((entity) => entity.shape)) shown.push(this.colorRow());
    const start = this.startRows();
    this.rows = [...(single ? [this.nameRow()] : []), ...shown, ...start];
    const card = single?.model ? modelCard(this.parts, single.model) : null;
    const head = single ? this.rows[0]!.root : element("h2", { "data-testid": "selection-count" }, `${entities.length} entities`);
    this.root.replaceChildren(
      head,
      ...(card ? [card] : []),
      element("details", { class: "group", open: true }, element("summary", {}, "Place and size"), ...shown.map((row) => row.root)),
      element("details", { class: "group" }, element("summary", {}, "Start and forces"), ...start.map((row) => row.root)),
    );
    this.update();
  }

  private update(): void {
    const entities = this.entities();
    if (entities.length > 0) for (const row of this.rows) row.update(entities);
  }

  private nameRow(): Row {
    const field = textField("Name", (name) => this.change({ name }));
    field.root.classList.add("name-field");
    field.root.querySelector("input")!.dataset["testid"] = "entity-name";
    return { root: field.root, update: ([entity]) => field.set(nameOf(entity!)) };
  }

  private poseRows(): Row[] {
    const position = vectorField(["Position x", "Position y", "Position z"], "m", (value) => this.move(value as Vector, null), 0.01);
    const rotation = vectorField(["Rotation x", "Rotation y", "Rotation z"], "°", (value) => this.move(null, value as Vector), 1);
    const matrix = new Matrix4();
    const [at, turn, size, euler] = [new Vector3(), new Quaternion(), new Vector3(), new Euler()];
    const update = (entities: Entity[]): void => {
      const last = entities.at(-1)!;
      if (entities.length > 1 || !this.parts.entities.matrixOf(last.index, performance.now(), matrix)) {
        position.set(null);
        rotation.set(null);
        return;
      }
      matrix.decompose(at, turn, size);
      euler.setFromQuaternion(turn, "YXZ");
      position.set(at.toArray().map(rounded));
      rotation.set([euler.x, euler.y, euler.z].map((angle) => Math.round((angle / DEGREE) * 100) / 100));
    };
    return [
      { root: row("Position", position.root), update },
      { root: row("Rotation", rotation.root), update: () => {} },
    ];
  }

  private move(position: Vector | null, degrees: Vector | null): void {
    const edit: Omit<PoseEdit, "index"> = {};
    if (position) edit.position = position;
    if (degrees) {
      const [x, y, z] = degrees.map((angle) => angle * DEGREE) as Vector;
      edit.rotation = new Quaternion().setFromEuler(new Euler(x, y, z, "YXZ")).toArray() as [number, number, number, number];
    }
    const poses = this.parts.selection.indices.map((index) => ({ index, ...edit }));
    void this.parts.server.command("entity.transform", { poses });
  }

  /** The lengths of a primitive, as full widths and heights. */
  private shapeRows(shape: Shape): Row[] {
    if (!isOfLengths(shape)) return [];
    return fieldsOf(shape).map((length) => {
      const present = () => (this.entities()[0]?.shape ?? shape) as ShapeOfLengths;
      const put = (shown: number | Vector) => this.change({ shape: withShownLength(present(), length, shown) });
      const shown = (entity: Entity) => shownLength(entity.shape as ShapeOfLengths, length);
      if (length.each) {
        const field = vectorField(length.each, "m", (value) => put(value as Vector), 0.01);
        return { root: row(length.label, field.root), update: ([entity]) => field.set(shown(entity!) as Vector) };
      }
      const field = numberField(length.label, "m", put, 0.01);
      return { root: row(length.label, field.root), update: ([entity]) => field.set(shown(entity!) as number) };
    });
  }

  private scaleRow(): Row {
    const field = numberField("Scale", "", (scale) => this.change({ scale }), 0.05);
    return { root: row("Scale", field.root), update: (entities) => field.set(common(entities, (entity) => entity.scale ?? 1)) };
  }

  private colorRow(): Row {
    const input = element("input", { type: "color", "aria-label": "Colour" });
    input.addEventListener("change", () => this.change({ color: new Color(input.value).toArray() as Vector }));
    return {
      root: row("Colour", element("span", { class: "field" }, input)),
      update: ([entity]) => {
        if (document.activeElement !== input) input.value = `#${colorOf(entity!).getHexString()}`;
      },
    };
  }

  private startRows(): Row[] {
    const vector = (label: string, unit: string, name: "linear_velocity" | "angular_velocity" | "force" | "torque"): Row => {
      const field = vectorField([`${label} x`, `${label} y`, `${label} z`], unit, (value) => this.change({ [name]: value as Vector }));
      return bound(label, field, (entity) => entity[name] ?? [0, 0, 0]);
    };
    const truth = (label: string, name: "enabled" | "start_asleep" | "continuous", standard: boolean): Row => {
      const field = truthField(label, (value) => this.change({ [name]: value }));
      return bound(label, field, (entity) => entity[name] ?? standard);
    };
    return [
      vector("Velocity", "m/s", "linear_velocity"),
      vector("Spin", "rad/s", "angular_velocity"),
      vector("Force", "N", "force"),
      vector("Torque", "N m", "torque"),
      truth("In the world", "enabled", true),
      truth("Starts asleep", "start_asleep", false),
      truth("Fast: never tunnels", "continuous", false),
    ];
  }

  private change(entity: NewEntity): void {
    // One undo takes back the change of all entities.
    const merge = `fields-${Date.now()}`;
    for (const index of this.parts.selection.indices) void this.parts.server.command("entity.update", { index, entity, merge });
  }
}

function row(label: string, field: HTMLElement): HTMLElement {
  return element("div", { class: "attribute" }, element("span", { class: "attribute-label" }, label), field);
}

function bound<Value>(label: string, field: Field<Value>, read: (entity: Entity) => Value): Row {
  return { root: row(label, field.root), update: (entities) => field.set(common(entities, read)) };
}

/** The value that all entities have, or null. */
function common<Value>(entities: Entity[], read: (entity: Entity) => Value): Value | null {
  const first = read(entities[0]!);
  const text = JSON.stringify(first);
  return entities.every((entity) => JSON.stringify(read(entity)) === text) ? first : null;
}

function rounded(length: number): number {
  return Math.round(length * 1e4) / 1e4;
}
