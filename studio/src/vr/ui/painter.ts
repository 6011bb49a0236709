// SPDX-License-Identifier: MIT
import { type IconName, strokesOf } from "../../tools/icons";

/** A rectangle on a panel, mm from its upper left corner. */
export interface Box {
  x: number;
  y: number;
  w: number;
  h: number;
}

/** The page's colours (style/theme.css), so that panels in the headset look like those on the page. */
const NAMES = ["ground", "panel", "raised", "hover", "line", "text", "dim", "accent", "accent-soft", "on-accent", "error", "wants"] as const;
export type ColorName = (typeof NAMES)[number];

/** Font size, mm. At 0.6 m a millimetre is 0.095°: 13 mm are 1.24°. */
export const TEXT = 16;
export const SMALL = 13;
/** The names of Chinese fonts are for systems whose own fallback is a Japanese one. */
const FONT = 'system-ui, "Segoe UI", "DejaVu Sans", "PingFang SC", "Microsoft YaHei", "Noto Sans CJK SC", sans-serif';

const paths = new Map<IconName, Path2D>();

/** The pieces of a text that a line may end after: words with the space behind them; Chinese characters with the marks that may not begin a line. */
function breakable(text: string): string[] {
  return text.replace(/\s+/g, " ").match(/[“（《]*\p{Script=Han}[，。；：、！？”）》…]*|(?:(?!\p{Script=Han}|[“（《]+\p{Script=Han})\S)+ ?| /gu) ?? [];
}

/** Draws on a panel's canvas in millimetres, in the page's colours. */
export class Painter {
  private colors = new Map<ColorName, string>();

  constructor(readonly context: CanvasRenderingContext2D) {
    this.readColors();
  }

  readColors(): void {
    const style = getComputedStyle(document.documentElement);
    for (const name of NAMES) this.colors.set(name, style.getPropertyValue(`--${name}`).trim());
  }

  color(name: ColorName): string {
    return this.colors.get(name) ?? "#888";
  }

  /** A rectangle with round corners. */
  fill({ x, y, w, h }: Box, radius: number, color: ColorName, alpha = 1): void {
    const { context } = this;
    context.globalAlpha = alpha;
    context.fillStyle = this.color(color);
    context.beginPath();
    context.roundRect(x, y, w, h, radius);
    context.fill();
    context.globalAlpha = 1;
  }

  outline({ x, y, w, h }: Box, radius: number, color: ColorName, width = 0.7): void {
    const { context } = this;
    context.strokeStyle = this.color(color);
    context.lineWidth = width;
    context.beginPath();
    context.roundRect(x + width / 2, y + width / 2, w - width, h - width, radius);
    context.stroke();
  }

  /** A line of text, its middle at height y; too long a text ends in an ellipsis. */
  text(text: string, x: number, y: number, { size = TEXT, color = "text" as ColorName, align = "left" as CanvasTextAlign, bold = false, width = Infinity } = {}): void {
    const { context } = this;
    context.font = `${bold ? 600 : 400} ${size}px ${FONT}`;
    context.fillStyle = this.color(color);
    context.textAlign = align;
    context.textBaseline = "middle";
    context.fillText(this.cut(text, width), x, y);
  }

  /** A text in at most `most` lines of a width. */
  lines(text: string, x: number, y: number, options: { size: number; color?: ColorName; align?: CanvasTextAlign; width: number; most: number }): void {
    const { size, width, most } = options;
    this.context.font = `400 ${size}px ${FONT}`;
    const lines: string[] = [];
    for (const piece of breakable(text)) {
      const last = lines.at(-1);
      if (last !== undefined && this.context.measureText((last + piece).trimEnd()).width <= width) lines[lines.length - 1] = last + piece;
      else lines.push(piece);
    }
    const shown = lines.slice(0, most);
    if (lines.length > most) shown[most - 1] = lines.slice(most - 1).join("");
    shown.forEach((line, at) => this.text(line.trimEnd(), x, y + at * 1.25 * size, options));
  }

  icon(name: IconName, x: number, y: number, size: number, color: ColorName = "text"): void {
    const { context } = this;
    const { path, filled } = strokesOf(name);
    let drawing = paths.get(name);
    if (!drawing) paths.set(name, (drawing = new Path2D(path)));
    context.save();
    context.translate(x - size / 2, y - size / 2);
    context.scale(size / 16, size / 16);
    context.lineWidth = 1.4;
    context.lineCap = context.lineJoin = "round";
    context.strokeStyle = context.fillStyle = this.color(color);
    if (filled) context.fill(drawing);
    else context.stroke(drawing);
    context.restore();
  }

  /** A picture, fitted into a box. */
  picture(picture: HTMLImageElement, { x, y, w, h }: Box): void {
    const scale = Math.min(w / picture.naturalWidth, h / picture.naturalHeight);
    const width = picture.naturalWidth * scale;
    const height = picture.naturalHeight * scale;
    this.context.drawImage(picture, x + (w - width) / 2, y + (h - height) / 2, width, height);
  }

  private cut(text: string, width: number): string {
    const { context } = this;
    if (width === Infinity || context.measureText(text).width <= width) return text;
    let length = text.length;
    while (length > 1 && context.measureText(`${text.slice(0, length)}…`).width > width) --length;
    return `${text.slice(0, length).trimEnd()}…`;
  }
}
