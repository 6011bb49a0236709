// SPDX-License-Identifier: MIT
import type { Parts } from "../parts";
import type { VrSettings } from "./settings";
import { Desk } from "./ui/desk";
import { type Box, SMALL } from "./ui/painter";
import { BAR, Panel } from "./ui/panel";
import { button, label, slider, type Widget } from "./ui/widgets";
import { t } from "../language";

const WIDTH = 380;
const ROW = 40;
const NAMED = 128;

/** Name, least and greatest value, and how the value is written. */
type Range = readonly [keyof VrSettings, string, number, number, (value: number) => string];
const RANGES: readonly Range[] = [
  ["vignette", t("Tunnel view"), 0, 1, (value) => (value === 0 ? t("off") : `${Math.round(100 * value)} %`)],
  ["heightOffset", t("Height"), -0.5, 1, (value) => `${value >= 0 ? "+" : ""}${Math.round(100 * value)} cm`],
  ["strength", t("Strength"), 20, 2000, (value) => `${Math.round(value)} N`],
  ["sharpness", t("Sharpness"), 0.5, 1.5, (value) => `${Math.round(100 * value)} %`],
  ["foveation", t("Coarse edge"), 0, 1, (value) => `${Math.round(100 * value)} %`],
];

type Choice = readonly [id: string, label: string, on: (vr: VrSettings) => boolean, change: Partial<VrSettings>];
const CHOICES: readonly (readonly [string, readonly Choice[]])[] = [
  [t("Left stick"), [["move-teleport", t("Teleport"), ({ walk }) => !walk, { walk: false }], ["move-walk", t("Walk"), ({ walk }) => walk, { walk: true }]]],
  [
    t("Turning"),
    [
      ["turn-30", "30°", ({ turn, turnAngle }) => turn === "snap" && turnAngle === 30, { turn: "snap", turnAngle: 30 }],
      ["turn-45", "45°", ({ turn, turnAngle }) => turn === "snap" && turnAngle === 45, { turn: "snap", turnAngle: 45 }],
      ["turn-smooth", t("Smooth"), ({ turn }) => turn === "smooth", { turn: "smooth" }],
    ],
  ],
  [t("Walls"), [["walls-stop", t("Stop me"), ({ walls }) => walls, { walls: true }], ["walls-pass", t("Let through"), ({ walls }) => !walls, { walls: false }]]],
  [t("Shaking"), [["haptics-on", t("On"), ({ haptics }) => haptics, { haptics: true }], ["haptics-off", t("Off"), ({ haptics }) => !haptics, { haptics: false }]]],
];
const HEIGHT = BAR + 14 + ROW * (RANGES.length + CHOICES.length + 2);

/** How the user moves, in the headset; every change is kept at once. */
export class SettingsPanel {
  readonly panel = new Panel({ id: "settings", title: t("Moving and holding"), width: WIDTH, height: HEIGHT, hasBar: true });

  constructor(
    private readonly parts: Pick<Parts, "preferences">,
    private readonly desk: Desk,
    private readonly openHelp: () => void,
  ) {
    desk.add(this.panel);
    parts.preferences.changed.on((name) => {
      if (name === "vr" || name === "sounds") this.renew();
    });
    this.renew();
  }

  open(): void {
    this.desk.open(this.panel, 0);
  }

  private help(): void {
    this.panel.show(false);
    this.openHelp();
  }

  private set(change: Partial<VrSettings>): void {
    const { preferences } = this.parts;
    preferences.set("vr", { ...preferences.get("vr"), ...change });
  }

  private renew(): void {
    const vr = this.parts.preferences.get("vr");
    const widgets: Widget[] = [Desk.closer(this.panel)];
    let y = BAR + 10;
    const row = (name: string, ...right: Widget[]): void => {
      widgets.push(label(`label-${name}`, { x: 14, y, w: NAMED - 18, h: ROW - 6 }, name, { size: SMALL + 1, color: "dim" }), ...right);
      y += ROW;
    };
    const buttons = (choices: readonly Choice[]): Widget[] => {
      const width = (WIDTH - NAMED - 12 - 4 * (choices.length - 1)) / choices.length;
      return choices.map(([id, name, on, change], at) => button({ id, label: name, on: on(vr), box: { x: NAMED + at * (width + 4), y, w: width, h: ROW - 6 }, run: () => this.set(change) }));
    };
    for (const [name, choices] of CHOICES) row(name, ...buttons(choices));
    const { preferences } = this.parts;
    const half = (WIDTH - NAMED - 16) / 2;
    const sound = (on: boolean, at: number): Widget => button({ id: `sounds-${on ? "on" : "off"}`, label: on ? t("On") : t("Off"), on: preferences.get("sounds") === on, box: { x: NAMED + at * (half + 4), y, w: half, h: ROW - 6 }, run: () => preferences.set("sounds", on) });
    row(t("Sounds"), sound(true, 0), sound(false, 1));
    for (const [key, name, low, high, text] of RANGES) {
      const value = vr[key] as number;
      const box: Box = { x: NAMED, y, w: WIDTH - NAMED - 80, h: ROW - 6 };
      const change = (part: number): void => this.set({ [key]: Number((low + part * (high - low)).toFixed(2)) });
      row(name, slider({ id: key, box, part: (value - low) / (high - low), change }), label(`value-${key}`, { x: WIDTH - 76, y, w: 64, h: ROW - 6 }, text(value), { size: SMALL + 1, align: "right" }));
    }
    widgets.push(button({ id: "controls", label: t("What your hands can do…"), icon: "help", wide: true, box: { x: 12, y, w: WIDTH - 24, h: ROW - 6 }, run: () => this.help() }));
    this.panel.widgets = widgets;
    this.panel.renew();
  }
}
