// SPDX-License-Identifier: MIT
import type { Action, Target } from "../connection/scene_types";
import { nameOf } from "../document/scene_document";
import type { Parts } from "../parts";
import { icon } from "../tools/icons";
import { type ActionParts, openAction } from "./action_dialog";
import { actionText, isCaused } from "./action_text";
import { element, setText, show } from "./element";
import { foldingGroup } from "./folding";
import { afterPress } from "./press";
import { t } from "../language";

const MOST = 200;

/** What happens in the scene, as sentences “When … then …”: of what is selected, or all. */
export class ActionList {
  readonly root: HTMLElement;
  private readonly list = element("ul", { class: "plain-list", "data-testid": "actions" });
  private readonly group: HTMLDetailsElement;
  private readonly advice = element("p", { class: "note" }, t("Nothing happens by itself yet: add a sentence."));

  constructor(private readonly parts: ActionParts & Pick<Parts, "preferences" | "notices" | "playback" | "picked">) {
    const add = element("button", { class: "chip", "data-testid": "add-action", onclick: () => openAction(parts) }, t("Add “When … then …”"));
    this.group = foldingGroup(parts.preferences, "actions", t("Actions"), false, this.advice, this.list, element("div", { class: "preset-chips" }, add));
    this.root = element("section", { class: "entity", "data-testid": "action-fields", "aria-label": t("Actions") }, this.group);
    const update = (): void => this.update();
    parts.selection.changed.on(update);
    parts.picked.changed.on(update);
    parts.document.changed.on(({ all, actions, entities, removed }) => (all || actions || entities.length + removed.length > 0) && afterPress(update));
    this.update();
  }

  private update(): void {
    const { document, selection, picked } = this.parts;
    const all = [...document.actions.values()].sort((a, b) => a.id - b.id);
    const shown = selection.indices.length === 0 ? all : all.filter((action) => this.concerns(action));
    show(this.root, !picked.model);
    setText(this.group.querySelector("summary")!, shown.length > 0 ? t("Actions ({{number}})", { number: shown.length }) : t("Actions"));
    show(this.advice, shown.length === 0);
    this.list.replaceChildren(...shown.slice(0, MOST).map((action) => this.row(action, all)), ...(shown.length > MOST ? [element("li", { class: "note" }, t("… and {{number}} more", { number: shown.length - MOST }))] : []));
  }

  /** Whether something selected sets it off or is changed by it. */
  private concerns({ sender, receiver, trigger }: Action): boolean {
    const targets = [sender, receiver, "other" in trigger ? trigger.other : undefined];
    return this.parts.selection.indices.some((index) => targets.some((target) => this.isMeant(target, index)));
  }

  private isMeant(target: Target | undefined, index: number): boolean {
    if (target === undefined || target === "any") return false;
    const entity = this.parts.document.entity(index);
    if ("index" in target) return target.index === index;
    return "name" in target ? entity?.name === target.name : entity?.category === target.category;
  }

  private row(action: Action, all: readonly Action[]): HTMLElement {
    const { server } = this.parts;
    const { id: index, name, enabled = true } = action;
    const place = all.findIndex(({ id }) => id === index) + 1;
    const text = actionText(action, (other) => {
      const entity = this.parts.document.entity(other);
      return entity ? nameOf(entity) : t("entity {{other}}", { other });
    });
    const box = element("input", {
      type: "checkbox",
      title: enabled ? t("Happens. Click: it does not") : t("Does not happen. Click: it does"),
      "aria-label": t("Enabled: {{name}}", { name: name || text }),
      "data-testid": `action-enabled-${index}`,
      onchange: () => void server.command("action.update", { index, action: { enabled: box.checked } }),
    });
    box.checked = enabled;
    const button = (label: string, testId: string, content: Node | string, disabled: boolean, run: () => void) =>
      element("button", { class: "plain", title: label, "aria-label": `${label}: ${name || text}`, "data-testid": `${testId}-${index}`, disabled, onclick: run }, content);
    return element(
      "li",
      { class: enabled ? "" : "disabled" },
      element("div", { class: "list-head" }, box, element("button", { class: "list-title", title: t("Change it"), "data-testid": `action-${index}`, onclick: () => openAction(this.parts, action) }, ...(name ? [element("strong", {}, name)] : []), element("span", {}, text))),
      element(
        "div",
        { class: "list-buttons" },
        button(t("Try it now"), "action-test", icon("play"), false, () => void this.test(action)),
        button(t("Earlier"), "action-up", icon("up"), place === 1, () => void server.command("action.move", { index, place: place - 1 })),
        button(t("Later"), "action-down", icon("down"), place === all.length, () => void server.command("action.move", { index, place: place + 1 })),
        button(t("Delete"), "action-delete", icon("bin"), false, () => void server.command("action.remove", { index })),
      ),
    );
  }

  /** Carries it out in a run, which begins where there is none. */
  private async test({ id: index, trigger, sender }: Action): Promise<void> {
    const { server, playback, selection } = this.parts;
    if (!playback.playing && !(await server.command("simulation.play", {}))) return;
    const chosen = selection.indices[0];
    const needsSender = isCaused(trigger) && (sender === undefined || sender === "any") && chosen !== undefined;
    await server.command("action.run", needsSender ? { index, sender: chosen } : { index });
  }
}
