// SPDX-License-Identifier: MIT
import { Box3, Vector3 } from "three";
import type { JointEdit } from "../connection/messages";
import type { Joint, JointLimit, JointMotor, Vector } from "../connection/scene_types";
import { withTyped } from "../document/components";
import { nameOf } from "../document/scene_document";
import type { Parts } from "../parts";
import { icon } from "../tools/icons";
import { hasAxis, type JointTool } from "../tools/joint_tool";
import { element, setText, show } from "./element";
import { numberField, textField, truthField, vectorField } from "./fields";
import { foldingGroup } from "./folding";
import { numberText } from "./number_text";
import { t } from "../language";

const KINDS: readonly { type: Joint["type"]; label: string; help: string }[] = [
  { type: "hinge", label: t("Hinge"), help: t("Turns about one axis, like a door or a wheel") },
  { type: "slider", label: t("Slider"), help: t("Moves along one axis, like a drawer") },
  { type: "ball", label: t("Ball"), help: t("Turns freely about one point, like a chain's link") },
  { type: "fixed", label: t("Fixed"), help: t("Keeps both together as if glued") },
];
const AXES: readonly (readonly [string, Vector])[] = [["X", [1, 0, 0]], [t("Y up"), [0, 1, 0]], ["Z", [0, 0, 1]]];
/** In a large scene only so many entities and joints are offered. */
const MOST = 300;
const WORLD = "";
const DEGREE = Math.PI / 180;
/** What a limit or a motor has when it is switched on. */
const FIRST_LIMITS: Record<string, JointLimit> = { hinge: { lower: -90 * DEGREE, upper: 90 * DEGREE }, slider: { lower: 0, upper: 0.4 } };
const FIRST_MOTORS: Record<string, JointMotor> = { hinge: { speed: 1, max_force: 20 }, slider: { speed: 0.2, max_force: 100 } };

/** Rows of the editor, and what shows a joint in them. */
type MoreRows = { rows: HTMLElement[]; fill: (joint: Joint) => void };

type JointParts = Pick<Parts, "preferences" | "server" | "document" | "selection" | "playback" | "entities" | "view">;

/** The joints of what is selected, or of all: added, changed and removed; shown in the picture. */
export class JointFields {
  readonly root: HTMLElement;
  private readonly add = element("div", { class: "preset-chips", "data-testid": "add-joint" });
  private readonly advice = element("p", { class: "note" });
  private readonly list = element("ul", { class: "plain-list", "data-testid": "joints" });
  private readonly group: HTMLDetailsElement;
  private chosen = 0;
  /** Shown when the chosen joint's fields are not being typed in. */
  private refill: (() => void) | null = null;
  private shape = "";

  constructor(
    private readonly parts: JointParts,
    private readonly tool: JointTool,
  ) {
    this.group = foldingGroup(parts.preferences, "joints", t("Joints"), false, this.advice, this.add, this.list);
    this.root = element("section", { class: "entity", "data-testid": "joint-fields", "aria-label": t("Joints") }, this.group);
    this.add.append(...KINDS.map(({ type, label, help }) => element("button", { class: "chip", title: help, "data-testid": `add-joint-${type}`, onclick: () => void this.make(type) }, label)));
    parts.selection.changed.on(() => this.update());
    parts.document.changed.on(({ all, joints, entities }) => (all || joints || entities.length > 0) && this.update());
    this.group.addEventListener("toggle", () => this.update());
    tool.changed.on(() => this.update(true));
    this.update();
  }

  private joints(): Joint[] {
    const { document, selection } = this.parts;
    const all = [...document.joints.values()];
    if (selection.indices.length === 0) return all;
    return all.filter(({ entity_a, entity_b }) => selection.has(entity_b) || (entity_a !== undefined && selection.has(entity_a)));
  }

  private update(anew = false): void {
    const { selection } = this.parts;
    const joints = this.joints();
    const count = selection.indices.length;
    setText(this.group.querySelector("summary")!, joints.length > 0 ? t("Joints ({{number}})", { number: joints.length }) : t("Joints"));
    show(this.root, count > 0 || joints.length > 0);
    show(this.add, count === 1 || count === 2);
    setText(this.advice, count === 1 ? t("Join it to the world by a:") : count === 2 ? t("Join the two by a:") : count > 2 ? t("Select one thing, or two, to join them.") : t("All joints of the scene. Select one thing, or two, to add one."));
    if (!joints.some(({ index }) => index === this.chosen)) this.chosen = 0;
    this.tool.show(this.group.open ? joints.map(({ index }) => index) : [], this.chosen);
    const shape = JSON.stringify([this.chosen, this.tool.picking, this.tool.turning, joints.slice(0, MOST).map(({ index, type, name, entity_a, entity_b, ...each }) => [index, type, name, entity_a, entity_b, index === this.chosen && ["limit" in each && !!each.limit, "motor" in each && !!each.motor]])]);
    if (anew || shape !== this.shape) {
      this.shape = shape;
      this.refill = null;
      this.list.replaceChildren(...joints.slice(0, MOST).map((joint) => this.row(joint)), ...(joints.length > MOST ? [element("li", { class: "note" }, t("… and {{number}} more", { number: joints.length - MOST }))] : []));
    }
    this.refill?.();
  }

  private called(index: number | undefined): string {
    if (index === undefined) return t("the world");
    const entity = this.parts.document.entity(index);
    return entity ? nameOf(entity) : t("entity {{index}}", { index });
  }

  private row(joint: Joint): HTMLElement {
    const { index, type, name } = joint;
    const isChosen = index === this.chosen;
    const label = KINDS.find((kind) => kind.type === type)!.label;
    const choose = (): void => {
      this.chosen = isChosen ? 0 : index;
      this.update();
    };
    const head = element(
      "div",
      { class: "list-head" },
      element("button", { class: "list-title", "aria-expanded": String(isChosen), "data-testid": `joint-${index}`, onclick: choose }, element("strong", {}, name || label), element("span", { class: "note" }, `${this.called(joint.entity_a)} – ${this.called(joint.entity_b)}`)),
      element("button", { class: "plain", title: t("Delete this joint"), "aria-label": t("Delete joint {{name}}", { name: name || label }), "data-testid": `joint-delete-${index}`, onclick: () => void this.parts.server.command("joint.remove", { index }) }, icon("bin")),
    );
    return element("li", { class: isChosen ? "chosen" : "" }, head, isChosen ? this.editor(joint) : null);
  }

  private change(joint: JointEdit): void {
    void this.parts.server.command("joint.update", { index: this.chosen, joint });
  }

  /** The fields of the chosen joint. */
  private editor(joint: Joint): HTMLElement {
    const { tool } = this;
    const now = () => this.parts.document.joints.get(joint.index) ?? joint;
    const place = () => tool.placeOf(now());
    const name = textField(t("Name of the joint"), (text) => this.change({ name: text }), KINDS.find(({ type }) => type === joint.type)!.label);
    const anchor = vectorField([t("Anchor x"), t("Anchor y"), t("Anchor z")], "m", (typed) => this.change({ anchor: withTyped(place()?.anchor.toArray() ?? [0, 0, 0], typed) as Vector }), 0.01);
    const axis = vectorField([t("Axis x"), t("Axis y"), t("Axis z")], "", (typed) => this.change({ axis: withTyped(place()?.axis.toArray() ?? [1, 0, 0], typed) as Vector }), 0.05);
    const collide = truthField(t("Touch each other"), (bodies_collide) => this.change({ bodies_collide }));
    const rows: (HTMLElement | null)[] = [
      row(t("Name"), name.root),
      row(t("Kind"), choice(t("Kind of joint"), KINDS.map(({ type, label }) => [type, label]), joint.type, (type) => this.change({ type }))),
      row(t("Between"), this.end(t("First thing"), joint.entity_a, (entity_a) => this.change({ entity_a: entity_a ?? null }), true)),
      row(t("and"), this.end(t("Second thing"), joint.entity_b, (entity_b) => entity_b !== undefined && this.change({ entity_b }), false)),
      row(t("Anchor"), anchor.root, t("Where the joint is")),
      element("div", { class: "preset-chips" }, element("button", { class: "chip", "aria-pressed": String(tool.picking), "data-testid": "pick-anchor", onclick: () => tool.pick(!tool.picking) }, tool.picking ? t("Click on the place…") : t("Pick in the picture"))),
    ];
    const more = hasAxis(joint) ? [this.limitRows(now), this.motorRows(now)] : [];
    if (hasAxis(joint)) {
      rows.push(
        row(t("Axis"), axis.root, joint.type === "hinge" ? t("What it turns about") : t("Along what it slides")),
        element(
          "div",
          { class: "preset-chips" },
          ...AXES.map(([label, vector]) => element("button", { class: "chip", "data-testid": `axis-${label[0]}`, onclick: () => this.change({ axis: vector }) }, label)),
          element("button", { class: "chip", "aria-pressed": String(tool.turning), "data-testid": "turn-axis", onclick: () => tool.turn(!tool.turning) }, t("Turn by handles")),
        ),
        ...more.flatMap(({ rows: each }) => each),
      );
    }
    rows.push(row(t("Touch each other"), collide.root, t("Whether the two things collide")));
    this.refill = () => {
      const joined = now();
      const at = place();
      name.set(joined.name ?? "");
      collide.set(joined.bodies_collide ?? false);
      if (at) {
        anchor.set(at.anchor.toArray().map(rounded));
        axis.set(at.axis.toArray().map(rounded));
      }
      for (const { fill } of more) fill(joined);
    };
    return element("div", { class: "joint-editor" }, ...rows);
  }

  /** Angles are shown in degrees. */
  private limitRows(now: () => Joint): MoreRows {
    const of = (joint: Joint) => ("limit" in joint ? joint.limit : undefined);
    const type = now().type;
    const factor = type === "hinge" ? DEGREE : 1;
    const unit = type === "hinge" ? "°" : "m";
    const has = truthField(t("Has limits"), (on) => this.change({ limit: on ? FIRST_LIMITS[type] : null }));
    const put = (part: Partial<JointLimit>) => this.change({ limit: { ...of(now())!, ...part } });
    const lower = numberField(t("Lower limit"), unit, (value) => put({ lower: value * factor }), { step: type === "hinge" ? 5 : 0.05 });
    const upper = numberField(t("Upper limit"), unit, (value) => put({ upper: value * factor }), { step: type === "hinge" ? 5 : 0.05 });
    const fill = (joint: Joint): void => {
      const limit = of(joint);
      has.set(limit !== undefined);
      if (!limit) return;
      lower.set(rounded(limit.lower / factor));
      upper.set(rounded(limit.upper / factor));
    };
    const rows = [row(t("Limits"), has.root, type === "hinge" ? t("How far it turns, from where it is now") : t("How far it slides, from where it is now"))];
    return { rows: of(now()) ? [...rows, row(t("from"), lower.root), row(t("to"), upper.root)] : rows, fill };
  }

  private motorRows(now: () => Joint): MoreRows {
    const of = (joint: Joint) => ("motor" in joint ? joint.motor : undefined);
    const type = now().type;
    const has = truthField(t("Has a motor"), (on) => this.change({ motor: on ? FIRST_MOTORS[type] : null }));
    const put = (part: Partial<JointMotor>) => this.change({ motor: { ...of(now())!, ...part } });
    const speed = numberField(t("Motor speed"), type === "hinge" ? "rad/s" : "m/s", (value) => put({ speed: value }));
    const force = numberField(t("Motor strength"), type === "hinge" ? "N m" : "N", (value) => put({ max_force: value }));
    const fill = (joint: Joint): void => {
      const motor = of(joint);
      has.set(motor !== undefined);
      if (!motor) return;
      speed.set(motor.speed ?? 0);
      force.set(motor.max_force);
    };
    const rows = [row(t("Motor"), has.root, t("Drives it"))];
    return { rows: of(now()) ? [...rows, row(t("speed"), speed.root), row(t("strength"), force.root, t("At most"))] : rows, fill };
  }

  private end(label: string, value: number | undefined, commit: (index: number | undefined) => void, mayBeWorld: boolean): HTMLElement {
    const entities = [...this.parts.document.entities.values()].slice(0, MOST).map((entity): [string, string] => [String(entity.index), nameOf(entity)]);
    const known = value === undefined || entities.some(([index]) => index === String(value)) ? [] : [[String(value), this.called(value)] as [string, string]];
    return choice(label, [...(mayBeWorld ? [[WORLD, t("the world")] as [string, string]] : []), ...known, ...entities], value === undefined ? WORLD : String(value), (index) => commit(index === WORLD ? undefined : Number(index)));
  }

  /** A joint where the two boxes are nearest, or at the foot of one that hangs on the world. */
  private async make(type: Joint["type"]): Promise<void> {
    const { selection, entities, server } = this.parts;
    const [first, second] = selection.indices;
    if (first === undefined) return;
    const box = (index: number) => entities.boundsOf([index], performance.now());
    const ends: JointEdit = second === undefined ? { entity_b: first } : { entity_a: first, entity_b: second };
    const anchor = second === undefined ? box(first).getCenter(new Vector3()) : between(box(first), box(second));
    const made = await server.command("joint.add", { type, ...ends, anchor: anchor.toArray() as Vector, axis: [0, 1, 0] });
    if (!made) return;
    this.chosen = made.index;
    this.group.open = true;
    this.update();
  }
}

/** The middle of what two boxes share, or of the gap between them. */
function between(a: Box3, b: Box3): Vector3 {
  const low = a.min.clone().max(b.min);
  const high = a.max.clone().min(b.max);
  return low.add(high).multiplyScalar(0.5);
}

function row(label: string, field: HTMLElement, help = ""): HTMLElement {
  return element("div", { class: "attribute" }, element("span", { class: "attribute-label", title: help }, label), field);
}

function choice(label: string, options: readonly (readonly [string, string])[], value: string, commit: (value: never) => void): HTMLElement {
  const select = element("select", { "aria-label": label }, ...options.map(([each, text]) => element("option", { value: each, selected: each === value }, text)));
  select.addEventListener("change", () => commit(select.value as never));
  return element("span", { class: "field" }, select);
}

function rounded(value: number): number {
  return Number(numberText(Math.round(value * 1e4) / 1e4)) + 0;
}
