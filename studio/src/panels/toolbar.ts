// SPDX-License-Identifier: MIT
import type { Parts } from "../parts";
import type { UserAction } from "../tools/actions";
import type { Gizmo } from "../tools/gizmo";
import { keysOf } from "../tools/keys";
import { element, setText, show } from "./element";
import { icon } from "../tools/icons";
import { t, translateServerText } from "../language";

const GROUPS = [
  ["scene.new", "scene.open", "scene.save"],
  ["edit.undo", "edit.redo", "edit.delete"],
  ["tool.select", "tool.move", "tool.rotate", "tool.scale"],
  ["tool.space", "tool.snap"],
  ["build.wall", "view.plan"],
  ["simulation.reset", "simulation.play", "simulation.step", "simulation.keep"],
];
const GROUPS_RIGHT = [["catalog.history"], ["view.tint", "view.options", "view.screenshot", "view.palette", "view.help"]];

/** The bar at the top: a button for each action, and the scene's own buttons. */
export class Toolbar {
  readonly root: HTMLElement;
  private readonly title = element("button", { class: "scene-title", title: t("Rename: save under a name"), "data-testid": "scene-title" });
  private readonly sceneButtons = element("div", { class: "tool-group scene-buttons", role: "group", "aria-label": t("The scene's buttons") });
  private readonly buttons = new Map<UserAction, HTMLButtonElement>();

  constructor(
    private readonly parts: Pick<Parts, "preferences" | "server" | "notices" | "document" | "people" | "playback" | "selection" | "view">,
    gizmo: Gizmo,
    private readonly actions: readonly UserAction[],
    people: HTMLElement,
  ) {
    const find = (id: string) => actions.find((action) => action.id === id);
    const group = (ids: string[]) =>
      element("div", { class: "tool-group", role: "group" }, ...ids.flatMap((id) => find(id) ?? []).map((action) => this.button(action)));
    this.title.addEventListener("click", () => find("scene.save_as")?.run());
    this.root = element(
      "header",
      { class: "toolbar", role: "toolbar", "aria-label": t("Tools") },
      element("strong", { class: "brand" }, "Embody"),
      this.title,
      ...GROUPS.map(group),
      this.sceneButtons,
      element("span", { class: "spacer" }),
      people,
      ...GROUPS_RIGHT.map(group),
    );
    parts.document.changed.on(() => this.refresh());
    parts.document.historyChanged.on(() => this.refresh());
    parts.people.changed.on(() => this.refresh());
    parts.playback.changed.on(() => this.refresh());
    parts.selection.changed.on(() => this.refresh());
    parts.preferences.changed.on(() => this.refresh());
    gizmo.changed.on(() => this.refresh());
    parts.document.changed.on((changed) => changed.actions && this.showSceneButtons());
    this.refresh();
    this.showSceneButtons();
  }

  private button(action: UserAction): HTMLButtonElement {
    const key = keysOf(this.parts, action)[0];
    const button = element(
      "button",
      {
        class: "tool-button",
        title: key ? `${action.label} (${key})` : action.label,
        "aria-label": action.label,
        "data-testid": action.id,
        onclick: (event: MouseEvent) => {
          action.run();
          // After a click the keyboard focus returns to the scene; after a key press it stays on the button.
          if (event.detail > 0 && !document.querySelector("dialog[open]")) this.parts.view.canvas.focus();
        },
      },
      icon(action.icon ?? "options"),
    );
    this.buttons.set(action, button);
    return button;
  }

  refresh(): void {
    const { document: scene, playback } = this.parts;
    for (const [action, button] of this.buttons) {
      button.disabled = !(action.possible?.() ?? true);
      if (action.on) button.setAttribute("aria-pressed", String(action.on()));
    }
    const play = this.actions.find(({ id }) => id === "simulation.play");
    const playButton = play && this.buttons.get(play);
    if (playButton) {
      playButton.replaceChildren(icon(playback.playing ? "pause" : "play"));
      playButton.setAttribute("aria-label", playback.playing ? t("Pause") : t("Play"));
      playButton.title = `${playback.playing ? t("Pause") : t("Play")} (Space)`;
    }
    const undo = this.buttonOf("edit.undo");
    if (undo) undo.title = scene.undo ? t("Undo: {{undo}} (Ctrl+Z)", { undo: translateServerText(scene.undo) }) : t("Nothing to undo");
    const redo = this.buttonOf("edit.redo");
    if (redo) redo.title = scene.redo ? t("Redo: {{redo}} (Ctrl+Shift+Z)", { redo: translateServerText(scene.redo) }) : t("Nothing to redo");
    const name = scene.title || scene.name || t("Untitled");
    setText(this.title, scene.unsaved ? `${name} •` : name);
    this.title.setAttribute("aria-label", scene.unsaved ? t("Scene {{name}}, not saved", { name }) : t("Scene {{name}}", { name }));
    document.title = `${scene.unsaved ? "• " : ""}${name} – Embody Studio`;
  }

  private buttonOf(id: string): HTMLButtonElement | undefined {
    const action = this.actions.find((each) => each.id === id);
    return action && this.buttons.get(action);
  }

  /** A button for each name that an action of the scene waits for. */
  private showSceneButtons(): void {
    const names = new Set<string>();
    for (const { trigger } of this.parts.document.actions.values()) if (trigger.type === "signal" && trigger.button) names.add(trigger.button);
    this.sceneButtons.replaceChildren(
      ...[...names].map((button) =>
        element("button", { class: "scene-button", title: t("A button of this scene: starts “{{button}}”", { button }), "data-testid": `scene-button-${button}`, onclick: () => void this.trigger(button) }, button),
      ),
    );
    show(this.sceneButtons, names.size > 0);
  }

  private async trigger(button: string): Promise<void> {
    const answer = await this.parts.server.command("action.trigger", { button });
    if (answer?.started === 0) this.parts.notices.tell({ level: "info", text: t("“{{button}}” does nothing now", { button }), remedy: t("Play the scene first; an action may also act only once a run.") });
  }
}
