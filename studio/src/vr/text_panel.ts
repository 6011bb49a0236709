// SPDX-License-Identifier: MIT
import { Desk } from "./ui/desk";
import { keyboard } from "./ui/keyboard";
import { SMALL, TEXT } from "./ui/painter";
import { BAR, Panel } from "./ui/panel";
import { button, label, type Widget } from "./ui/widgets";
import { t } from "../language";

const WIDTH = 400;
const HEIGHT = 300;

/** Asks for a line of text, such as the name to save under, or for a yes or no. */
export class TextPanel {
  readonly panel = new Panel({ id: "ask", title: "", width: WIDTH, height: HEIGHT, hasBar: true });
  private text = "";

  constructor(private readonly desk: Desk) {
    desk.add(this.panel);
  }

  /** `done` gets the text that the user typed. */
  ask(title: string, text: string, done: (text: string) => void): void {
    this.text = text;
    this.panel.options.title = title;
    const set = (next: string): void => {
      this.text = next;
      this.panel.widgets = lay();
      this.panel.renew();
    };
    const finish = (): void => {
      if (this.text.trim() === "") return;
      this.panel.show(false);
      done(this.text.trim());
    };
    const lay = (): Widget[] => [
      Desk.closer(this.panel),
      field("text", this.text),
      ...keyboard({ box: { x: 12, y: BAR + 56, w: WIDTH - 24, h: HEIGHT - BAR - 68 }, type: (more) => set(this.text + more), erase: () => set(this.text.slice(0, -1)), done: finish, listen: null, hears: false }),
    ];
    this.panel.widgets = lay();
    this.desk.open(this.panel);
  }

  /** Offers answers; a closed panel is none of them. */
  choose(title: string, text: string, answers: readonly { id: string; label: string; run: () => void }[]): void {
    this.panel.options.title = title;
    const width = (WIDTH - 24 - 8 * (answers.length - 1)) / answers.length;
    this.panel.widgets = [
      Desk.closer(this.panel),
      label("text", { x: 16, y: BAR + 16, w: WIDTH - 32, h: 150 }, text, { rows: 6 }),
      ...answers.map(({ id, label: name, run }, at) =>
        button({
          id,
          label: name,
          box: { x: 12 + at * (width + 8), y: HEIGHT - 60, w: width, h: 46 },
          run: () => {
            this.panel.show(false);
            run();
          },
        }),
      ),
    ];
    this.desk.open(this.panel);
  }
}

function field(id: string, text: string): Widget {
  const box = { x: 12, y: BAR + 10, w: WIDTH - 24, h: 36 };
  return {
    id,
    box,
    off: true,
    paint: (painter) => {
      painter.fill(box, 6, "ground");
      painter.outline(box, 6, "accent", 1);
      painter.text(text || t("Name"), box.x + 12, box.y + box.h / 2, { size: TEXT, color: text ? "text" : "dim", width: box.w - 24 });
    },
  };
}

/** A short message before the user's eyes that goes by itself. */
export class MessagePanel {
  readonly panel = new Panel({ id: "message", title: "", width: 340, height: 84, isPassive: true });
  private left = 0;

  constructor(private readonly desk: Desk) {
    desk.add(this.panel);
  }

  tell(level: "info" | "warning" | "error", text: string, remedy = ""): void {
    this.left = 4 + (text.length + remedy.length) / 18;
    this.panel.widgets = [
      { id: "level", box: { x: 8, y: 12, w: 4, h: 60 }, off: true, paint: (painter) => painter.fill({ x: 8, y: 12, w: 4, h: 60 }, 2, level === "error" ? "error" : level === "warning" ? "accent" : "wants") },
      label("text", { x: 22, y: 8, w: 306, h: 34 }, text, { size: SMALL + 1, rows: 2 }),
      label("remedy", { x: 22, y: 46, w: 306, h: 34 }, remedy, { size: SMALL, color: "dim", rows: 2 }),
    ];
    this.desk.open(this.panel, 0, 0.26);
  }

  update(seconds: number): void {
    if (this.left <= 0) return;
    this.left -= seconds;
    if (this.left <= 0) this.panel.show(false);
  }
}
