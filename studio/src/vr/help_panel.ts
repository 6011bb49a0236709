// SPDX-License-Identifier: MIT
import { CONTROLS, HAND_CONTROLS } from "./controls";
import { Desk } from "./ui/desk";
import { SMALL, TEXT } from "./ui/painter";
import { BAR, Panel } from "./ui/panel";
import { label, type Widget } from "./ui/widgets";
import { t } from "../language";

/** mm */
const WIDTH = 440;
const ROW = 25;
const LEFT = 212;
const HEIGHT = BAR + 44 + ROW * (CONTROLS.length + HAND_CONTROLS.length + 1);

/** What the hands can do, as a card in the room. */
export class HelpPanel {
  readonly panel = new Panel({ id: "help", title: t("What your hands can do"), width: WIDTH, height: HEIGHT, hasBar: true });

  constructor(private readonly desk: Desk) {
    desk.add(this.panel);
    let y = BAR + 12;
    const rows: Widget[] = [];
    const row = (gesture: string, what: string): void => {
      rows.push(label(`gesture-${y}`, { x: 14, y, w: LEFT - 20, h: ROW }, gesture, { size: SMALL, color: "accent" }), label(`what-${y}`, { x: LEFT, y, w: WIDTH - LEFT - 12, h: ROW }, what, { size: SMALL }));
      y += ROW;
    };
    for (const [gesture, what] of CONTROLS) row(gesture, what);
    y += 8;
    rows.push(label("tracked", { x: 14, y, w: WIDTH - 28, h: ROW }, t("With your bare hands"), { size: TEXT, bold: true }));
    y += ROW;
    for (const [gesture, what] of HAND_CONTROLS) row(gesture, what);
    this.panel.widgets = [Desk.closer(this.panel), ...rows];
  }

  open(): void {
    this.desk.open(this.panel);
  }
}
