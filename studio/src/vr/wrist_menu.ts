// SPDX-License-Identifier: MIT
import { Matrix4, Vector3 } from "three";
import type { Parts } from "../parts";
import type { IconName } from "../tools/icons";
import type { UserAction } from "../tools/actions";
import type { Hands } from "./hand";
import type { Stance } from "./stance";
import type { Desk } from "./ui/desk";
import { Panel } from "./ui/panel";
import { button, type ButtonOptions, type Widget } from "./ui/widgets";
import { t } from "../language";

/** mm */
const WIDTH = 334;
const HEIGHT = 172;
const CELL = 62;
const TALL = 50;
const GAP = 3;
const EDGE = 6;
/** So far above the hand, m. */
const ABOVE = 0.13;
/** It shows while the back of the hand is turned to the eyes, as for reading a watch, and the eyes to it: cosines of the greatest angles, to show and to hide. */
const FACES = 0.7;
const LOOKS = 0.82;
const LEAVES = 0.55;

/** What the menu can do beside the actions of the page. */
export interface MenuChoices {
  leave(): void;
  save(): void;
  toggleDollhouse(): void;
  openModels(): void;
  openProperties(): void;
  openSettings(): void;
  toggleTape(): void;
  readonly tapeOn: boolean;
  readonly dollhouse: boolean;
}

/** The menu over the left wrist: shown when looked at, or before the user by a button. */
export class WristMenu {
  readonly panel = new Panel({ id: "wrist", title: t("Menu"), width: WIDTH, height: HEIGHT });
  /** Opened by the button: it stays where it is until the button is pressed again. */
  private isPinned = false;
  private readonly toEyes = new Vector3();
  private readonly face = new Vector3();
  private readonly gaze = new Vector3();
  private readonly matrix = new Matrix4();

  constructor(
    private readonly parts: Pick<Parts, "document" | "playback" | "preferences" | "selection">,
    private readonly desk: Desk,
    private readonly stance: Stance,
    private readonly actions: readonly UserAction[],
    private readonly choices: MenuChoices,
  ) {
    desk.add(this.panel);
    for (const signal of [parts.playback.changed, parts.selection.changed, parts.document.historyChanged]) signal.on(() => this.renew());
    parts.document.changed.on(() => this.renew());
    parts.preferences.changed.on(() => this.renew());
    this.renew();
  }

  renew(): void {
    this.panel.widgets = this.layOut();
    this.panel.renew();
  }

  /** The button of the left controller. */
  toggle(): void {
    this.isPinned = !this.isPinned;
    if (this.isPinned) this.desk.open(this.panel, -0.12);
    else this.panel.show(false);
  }

  /** Another panel takes its place. */
  unpin(): void {
    if (!this.isPinned) return;
    this.isPinned = false;
    this.panel.show(false);
  }

  update(hands: Hands): void {
    if (this.isPinned) return;
    const { left } = hands;
    const { panel } = this;
    if (!left.seen) {
      if (panel.isShown) panel.show(false);
      return;
    }
    // The back of a left hand: +Y of a tracked wrist, -X of a grip.
    const held = left.isTracked ? (left.joints.joints["wrist"] ?? left.ray) : left.grip.visible ? left.grip : left.ray;
    this.face.set(left.isTracked ? 0 : -1, left.isTracked ? 1 : 0, 0).applyQuaternion(held.quaternion);
    const { head } = this.stance;
    this.toEyes.copy(head.position).sub(held.position).normalize();
    this.gaze.set(0, 0, -1).applyQuaternion(head.quaternion);
    const faces = this.face.dot(this.toEyes);
    const looks = -this.gaze.dot(this.toEyes);
    if (!panel.isShown && faces > FACES && looks > LOOKS) panel.show(true);
    else if (panel.isShown && (faces < LEAVES || looks < LEAVES)) panel.show(false);
    if (!panel.isShown) return;
    const { mesh } = panel;
    mesh.position.copy(held.position);
    mesh.position.y += ABOVE;
    mesh.quaternion.setFromRotationMatrix(this.matrix.lookAt(head.position, mesh.position, mesh.up));
  }

  private layOut(): Widget[] {
    const { choices } = this;
    const playing = this.parts.playback.playing;
    const of = (id: string, label: string, icon?: IconName): Omit<ButtonOptions, "box"> => {
      const action = this.actions.find((each) => each.id === id);
      return { id, label, icon: icon ?? action?.icon, off: !action || !(action.possible?.() ?? true), on: id === "tool.snap" && action?.on?.() === true, run: () => action?.run() };
    };
    const rows: Omit<ButtonOptions, "box">[][] = [
      [
        { ...of("simulation.play", playing ? t("Pause") : t("Play"), playing ? "pause" : "play"), color: "accent" },
        of("simulation.step", t("Step")),
        of("simulation.reset", t("Reset")),
        of("simulation.keep", t("Settle")),
        { id: "save", label: t("Save"), icon: "save", run: () => choices.save() },
      ],
      [
        of("edit.undo", t("Undo")),
        of("edit.redo", t("Redo")),
        of("tool.snap", t("Snap")),
        { id: "tape", label: t("Measure"), icon: "tape", on: choices.tapeOn, run: () => choices.toggleTape() },
        { id: "dollhouse", label: choices.dollhouse ? t("Life-size") : "1 : 10", icon: choices.dollhouse ? "person" : "house", on: choices.dollhouse, run: () => choices.toggleDollhouse() },
      ],
      [
        { id: "models", label: t("Models"), icon: "models", run: () => choices.openModels() },
        { id: "properties", label: t("Details"), icon: "sliders", off: this.parts.selection.indices.length === 0, run: () => choices.openProperties() },
        of("edit.delete", t("Delete")),
        { id: "settings", label: t("Moving"), icon: "gear", run: () => choices.openSettings() },
        { id: "leave", label: t("Leave"), icon: "leave", run: () => choices.leave() },
      ],
    ];
    return rows.flatMap((row, line) => row.map((each, column) => button({ ...each, box: { x: EDGE + column * (CELL + GAP), y: EDGE + line * (TALL + GAP + 2), w: CELL, h: TALL } })));
  }
}
