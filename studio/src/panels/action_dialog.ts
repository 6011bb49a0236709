// SPDX-License-Identifier: MIT
// The editor of one action: a sentence of drop-downs, “When … then …”, that needs no code.
import { reasonText } from "../connection/connection";
import type { AttributeEntry, NewAction } from "../connection/messages";
import type { Action, Effect, Target, Trigger, Vector } from "../connection/scene_types";
import { nameOf, positionOf } from "../document/scene_document";
import { withTyped } from "../document/components";
import { isLiquid } from "../document/ports";
import type { Parts } from "../parts";
import { keyName } from "../tools/keys";
import { actionText, isCaused } from "./action_text";
import { fieldFor } from "./attribute_row";
import { dialogButtons, openDialog } from "./dialogs";
import { element, setText, show } from "./element";
import { numberField, textField, truthField, vectorField } from "./fields";
import { t, translateServerText } from "../language";

const TRIGGERS: readonly { type: Trigger["type"]; label: string; make: (near: Box) => Trigger }[] = [
  { type: "signal", label: t("a key or button is pressed"), make: () => ({ type: "signal", key: "K" }) },
  { type: "time", label: t("some time has passed"), make: () => ({ type: "time", time: 1 }) },
  { type: "contact_begin", label: t("something is touched"), make: () => ({ type: "contact_begin" }) },
  { type: "contact_end", label: t("something is no longer touched"), make: () => ({ type: "contact_end" }) },
  { type: "enter_volume", label: t("something comes into a box"), make: (near) => ({ type: "enter_volume", ...near }) },
  { type: "fall_asleep", label: t("something comes to rest"), make: () => ({ type: "fall_asleep" }) },
];
const EFFECTS: readonly { type: Effect["type"]; label: string; make: (near: Box) => Effect }[] = [
  { type: "apply_impulse", label: t("give a push"), make: () => ({ type: "apply_impulse", impulse: [0, 5, 0] }) },
  { type: "apply_force", label: t("push for a while"), make: () => ({ type: "apply_force", force: [0, 50, 0], duration: 1 }) },
  { type: "set_velocity", label: t("set the velocity"), make: () => ({ type: "set_velocity", linear: [0, 3, 0] }) },
  { type: "set_attribute", label: t("change a value"), make: () => ({ type: "set_attribute", name: "mass", value: 1 }) },
  { type: "spawn", label: t("add a copy"), make: ({ upper, lower }) => ({ type: "spawn", pose: { position: [(lower[0] + upper[0]) / 2, upper[1] + 1, (lower[2] + upper[2]) / 2] } }) },
  { type: "remove", label: t("remove"), make: () => ({ type: "remove" }) },
  { type: "set_enabled", label: t("switch on or off"), make: () => ({ type: "set_enabled", enabled: false }) },
  { type: "set_open", label: t("open or shut a tap or drain"), make: () => ({ type: "set_open", open: true }) },
  { type: "melt", label: t("melt a thing"), make: () => ({ type: "melt" }) },
  { type: "freeze", label: t("freeze a liquid"), make: () => ({ type: "freeze" }) },
  { type: "pause", label: t("pause the simulation"), make: () => ({ type: "pause" }) },
];
const ANY = "any";
/** In a large scene only so many entities are offered. */
const MOST_OFFERED = 300;

interface Box {
  lower: Vector;
  upper: Vector;
}
export type ActionParts = Pick<Parts, "server" | "document" | "selection" | "entities">;

/** What an editor starts with: a key that pushes what is selected. */
function firstAction({ selection }: ActionParts): NewAction {
  const [index] = selection.indices;
  return { trigger: { type: "signal", key: "K" }, effect: { type: "apply_impulse", impulse: [0, 5, 0] }, receiver: index === undefined ? "any" : { index }, once: false };
}

/** A box around the selection, or of a metre at the origin. */
function nearSelection({ selection, entities }: ActionParts): Box {
  const bounds = entities.boundsOf([...selection.indices], performance.now());
  if (selection.indices.length === 0 || bounds.isEmpty()) return { lower: [-0.5, 0, -0.5], upper: [0.5, 1, 0.5] };
  const round = (value: number) => Math.round(value * 100) / 100;
  return { lower: bounds.min.toArray().map(round) as Vector, upper: bounds.max.toArray().map(round) as Vector };
}

/** Edits an action of the scene, or without one makes a new one. */
export function openAction(parts: ActionParts, known?: Action): void {
  new ActionDialog(parts, known);
}

class ActionDialog {
  private readonly draft: NewAction;
  private readonly whenBox = element("div", { class: "sentence" });
  private readonly thenBox = element("div", { class: "sentence" });
  private readonly sentence = element("p", { class: "action-sentence", "data-testid": "action-sentence", "aria-live": "polite" });
  private readonly error = element("p", { class: "field-error", role: "alert" });
  private readonly dialog: HTMLDialogElement;
  /** The values of who is changed, to choose one of. */
  private values: readonly AttributeEntry[] = [];
  private asked = 0;

  constructor(
    private readonly parts: ActionParts,
    private readonly known: Action | undefined,
  ) {
    if (known) {
      const { id: _, ...rest } = structuredClone(known);
      this.draft = rest;
    } else this.draft = firstAction(parts);
    const name = textField(t("Name of the action"), (text) => this.put({ name: text }), t("no name"));
    name.set(this.draft.name ?? "");
    const once = truthField(t("Only once in a run"), (value) => this.put({ once: value }));
    once.set(this.draft.once ?? !this.repeats());
    show(this.error, false);
    this.dialog = openDialog(
      known ? t("Change an action") : t("A new action"),
      "action-dialog",
      element(
        "div",
        { class: "action-editor" },
        labelled(t("Name"), name.root),
        element("h3", {}, t("When")),
        this.whenBox,
        element("h3", {}, t("Then")),
        this.thenBox,
        labelled(t("Only once in a run"), once.root),
        this.sentence,
        this.error,
      ),
      dialogButtons(
        element("button", { onclick: () => this.dialog.close() }, t("Cancel")),
        element("button", { class: "primary", "data-testid": "action-save", onclick: () => void this.save() }, known ? t("Change") : t("Add")),
      ),
    );
    this.buildWhen();
    this.buildThen();
    void this.loadValues();
  }

  private repeats(): boolean {
    const { trigger } = this.draft;
    return trigger.type === "time" && trigger.repeat_every !== undefined;
  }

  private put(change: Partial<NewAction>): void {
    Object.assign(this.draft, change);
    const called = (index: number) => this.called(index);
    setText(this.sentence, actionText(this.draft, called));
  }

  private called(index: number): string {
    const entity = this.parts.document.entity(index);
    return entity ? nameOf(entity) : t("entity {{index}}", { index });
  }

  private buildWhen(): void {
    const { trigger, sender } = this.draft;
    const near = nearSelection(this.parts);
    const change = (fields: object): void => this.put({ trigger: { ...this.draft.trigger, ...fields } as Trigger });
    const rows: HTMLElement[] = [
      picker(t("When"), "trigger", TRIGGERS.map(({ type, label }) => [type, label]), trigger.type, (type) => {
        this.put({ trigger: TRIGGERS.find((each) => each.type === type)!.make(near), ...(isCaused({ type } as Trigger) ? {} : { sender: "any" }) });
        this.buildWhen();
        this.buildThen();
      }),
    ];
    if (isCaused(trigger)) rows.push(labelled(t("Who"), this.target(t("Who sets it off"), t("anything"), sender, (chosen) => this.put({ sender: chosen }))));
    switch (trigger.type) {
      case "signal": {
        const key = element("input", { type: "text", readonly: true, class: "key-field", "aria-label": t("Key"), "data-testid": "action-key", title: t("Click here, then press the key") });
        key.value = trigger.key ?? "";
        key.placeholder = t("press a key");
        key.addEventListener("keydown", (event) => {
          if (["Tab", "Escape", "Shift", "Control", "Alt", "Meta"].includes(event.key)) return;
          event.preventDefault();
          key.value = keyName(event);
          button.set("");
          change({ key: key.value, button: undefined });
        });
        const button = textField(t("Button of the page"), (text) => {
          key.value = "";
          change({ button: text, key: undefined });
        });
        button.set(trigger.button ?? "");
        rows.push(labelled(t("Key"), element("span", { class: "field" }, key)), labelled(t("or a button called"), button.root));
        break;
      }
      case "time": {
        const time = numberField(t("After"), "s", (value) => change({ time: value }));
        time.set(trigger.time ?? 0);
        const every = numberField(t("Then every"), "s", (value) => change({ repeat_every: value > 0 ? value : undefined }));
        every.set(trigger.repeat_every ?? 0);
        rows.push(labelled(t("After"), time.root), labelled(t("Then every"), every.root, t("0: not again")));
        break;
      }
      case "contact_begin":
      case "contact_end":
        rows.push(labelled(t("Whom"), this.target(t("What it touches"), t("anything"), trigger.other, (other) => change({ other }))));
        if (trigger.type === "contact_begin") {
          const speed = numberField(t("With at least"), "m/s", (value) => change({ least_approach_speed: value }));
          speed.set(trigger.least_approach_speed ?? 0);
          rows.push(labelled(t("With at least"), speed.root));
        }
        break;
      case "enter_volume":
        for (const [corner, label] of [["lower", t("Lowest corner")], ["upper", t("Highest corner")]] as const) {
          const field = vectorField([`${label} x`, `${label} y`, `${label} z`], "m", (typed) => {
            const now = this.draft.trigger as Extract<Trigger, { type: "enter_volume" }>;
            change({ [corner]: withTyped(now[corner], typed) });
          });
          field.set(trigger[corner]);
          rows.push(labelled(label, field.root));
        }
        break;
      case "fall_asleep":
        break;
    }
    this.whenBox.replaceChildren(...rows);
    this.put({});
  }

  private buildThen(): void {
    const { effect, receiver, trigger } = this.draft;
    const near = nearSelection(this.parts);
    const change = (fields: object): void => this.put({ effect: { ...this.draft.effect, ...fields } as Effect });
    const vector = (name: string, label: string, unit: string, value: Vector | undefined): HTMLElement => {
      let now: Vector = value ?? [0, 0, 0];
      const field = vectorField([`${label} x`, `${label} y`, `${label} z`], unit, (typed) => {
        now = withTyped(now, typed) as Vector;
        field.set(now);
        change({ [name]: now });
      });
      field.set(now);
      return labelled(label, field.root);
    };
    const rows: HTMLElement[] = [
      picker(t("Then"), "effect", EFFECTS.map(({ type, label }) => [type, label]), effect.type, (type) => {
        this.put({ effect: EFFECTS.find((each) => each.type === type)!.make(near) });
        this.buildThen();
        void this.loadValues();
      }),
    ];
    if (effect.type !== "pause")
      rows.push(
        labelled(
          effect.type === "spawn" ? t("Of what") : t("Whom"),
          this.target(t("Who is changed"), isCaused(trigger) ? t("who set it off") : t("everything"), receiver, (chosen) => {
            this.put({ receiver: chosen });
            void this.loadValues();
          }),
        ),
      );
    switch (effect.type) {
      case "apply_impulse":
        rows.push(vector("impulse", t("Push"), "N s", effect.impulse));
        break;
      case "apply_force": {
        const duration = numberField(t("For", { context: "time" }), "s", (value) => change({ duration: value }));
        duration.set(effect.duration ?? 0);
        rows.push(vector("force", t("Force"), "N", effect.force), labelled(t("For", { context: "time" }), duration.root));
        break;
      }
      case "set_velocity":
        rows.push(vector("linear", t("Velocity"), "m/s", effect.linear), vector("angular", t("Spin"), "rad/s", effect.angular));
        break;
      case "set_attribute":
        rows.push(...this.valueRows(effect, change));
        break;
      case "spawn": {
        let position = positionOf(effect.pose);
        const at = vectorField([t("Place x"), t("Place y"), t("Place z")], "m", (typed) => {
          position = withTyped(position, typed) as Vector;
          at.set(position);
          change({ pose: { ...effect.pose, position } });
        });
        at.set(position);
        rows.push(labelled(t("Place"), at.root), vector("linear_velocity", t("Velocity"), "m/s", effect.linear_velocity));
        break;
      }
      case "set_enabled": {
        const on = truthField(t("Switch on"), (enabled) => change({ enabled }));
        on.set(effect.enabled ?? true);
        rows.push(labelled(t("Switch on"), on.root, t("Off: it neither moves nor collides")));
        break;
      }
      case "set_open": {
        const open = truthField(t("Open", { context: "tap" }), (value) => change({ open: value }));
        open.set(effect.open ?? true);
        rows.push(labelled(t("Open", { context: "tap" }), open.root, t("Off: shut")));
        break;
      }
      case "melt":
        rows.push(labelled(t("Into"), this.liquid(effect.into ?? 0, (into) => change({ into })), t("The liquid that gains its drops, as many as have its mass")));
        break;
      case "remove":
      case "freeze":
      case "pause":
        break;
    }
    this.thenBox.replaceChildren(...rows);
    this.put({});
  }

  /** Which value, and what it becomes; by the values of who is changed. */
  private valueRows(effect: Extract<Effect, { type: "set_attribute" }>, change: (fields: object) => void): HTMLElement[] {
    const known = this.values.find(({ name }) => name === effect.name);
    const options = this.values.map(({ name, label }): [string, string] => [name, translateServerText(label)]);
    if (!known) options.push([effect.name, effect.name.replaceAll("_", " ")]);
    const rows = [
      picker(t("Which value"), "action-value", options, effect.name, (name) => {
        change({ name, value: this.values.find((each) => each.name === name)?.value });
        this.buildThen();
      }),
    ];
    if (!known) return rows;
    const field = fieldFor(known, (value) => change({ value }));
    field.set(effect.value as never);
    return [...rows, labelled(t("becomes"), field.root)];
  }

  private async loadValues(): Promise<void> {
    const { effect, receiver } = this.draft;
    if (effect.type !== "set_attribute") return;
    const asked = ++this.asked;
    const index = typeof receiver === "object" && "index" in receiver ? receiver.index : (this.parts.selection.indices[0] ?? [...this.parts.document.entities.keys()].at(-1));
    const told = index === undefined ? null : await this.parts.server.request("entity.attributes", { index }).catch(() => null);
    if (asked !== this.asked || !told) return;
    this.values = told.attributes;
    this.buildThen();
  }

  /** Everybody, one entity, or all of a category. */
  private target(label: string, any: string, value: Target | undefined, commit: (target: Target) => void): HTMLElement {
    const { entities } = this.parts.document;
    const categories = [...new Set([...entities.values()].flatMap(({ category }) => category || []))].sort();
    const text = value === undefined || value === "any" ? ANY : JSON.stringify(value);
    const options: [string, string][] = [
      [ANY, any],
      ...categories.map((category): [string, string] => [JSON.stringify({ category }), t("any {{category}}", { category: translateServerText(category) })]),
      ...[...entities.values()].slice(0, MOST_OFFERED).map((entity): [string, string] => [JSON.stringify({ index: entity.index }), nameOf(entity)]),
    ];
    if (!options.some(([each]) => each === text)) options.push([text, typeof value === "object" && "name" in value ? `“${value.name}”` : typeof value === "object" && "index" in value ? this.called(value.index) : text]);
    return select(label, "", options, text, (chosen) => commit(chosen === ANY ? "any" : (JSON.parse(chosen) as Target)));
  }

  /** A liquid of the scene, or one of its own for what melts. */
  private liquid(value: number, commit: (into: number) => void): HTMLElement {
    const { document, entities } = this.parts;
    const liquids = [...document.entities.values()].filter((entity) => isLiquid(entity, entities)).slice(0, MOST_OFFERED);
    const options: [string, string][] = [["0", t("a liquid of its own")], ...liquids.map(({ index }): [string, string] => [String(index), this.called(index)])];
    if (!options.some(([each]) => each === String(value))) options.push([String(value), this.called(value)]);
    return select(t("Into"), "melt-into", options, String(value), (chosen) => commit(Number(chosen)));
  }

  private async save(): Promise<void> {
    try {
      const { server } = this.parts;
      const cleaned = JSON.parse(JSON.stringify(this.draft)) as NewAction;
      if (this.known) await server.request("action.update", { index: this.known.id, action: cleaned });
      else await server.request("action.add", cleaned);
      this.dialog.close();
    } catch (error) {
      this.error.textContent = reasonText(error as Error);
      show(this.error, true);
    }
  }
}

function labelled(label: string, field: HTMLElement, help = ""): HTMLElement {
  return element("div", { class: "attribute" }, element("span", { class: "attribute-label", title: help }, label), field);
}

function select(label: string, testId: string, options: readonly (readonly [string, string])[], value: string, commit: (value: string) => void): HTMLElement {
  const list = element("select", { "aria-label": label, ...(testId && { "data-testid": testId }) }, ...options.map(([each, text]) => element("option", { value: each, selected: each === value }, text)));
  list.addEventListener("change", () => commit(list.value));
  return element("span", { class: "field" }, list);
}

function picker(label: string, testId: string, options: readonly (readonly [string, string])[], value: string, commit: (value: string) => void): HTMLElement {
  return element("div", { class: "sentence-head" }, select(label, testId, options, value, commit));
}
