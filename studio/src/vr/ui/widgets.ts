// SPDX-License-Identifier: MIT
import type { IconName } from "../../tools/icons";
import type { Side } from "../hand";
import { type Box, type ColorName, type Painter, SMALL, TEXT } from "./painter";

/** How a widget looks now. */
export interface Look {
  hover: boolean;
  pressed: boolean;
}

/** Something on a panel that is drawn, and that a ray or a finger may press. */
export interface Widget {
  readonly id: string;
  readonly box: Box;
  /** Cannot be pressed now. */
  readonly off?: boolean;
  paint(painter: Painter, look: Look): void;
  /** Pressed, moved and let go at a place of the panel, mm. */
  press?(x: number, y: number): void;
  move?(x: number, y: number): void;
  release?(x: number, y: number, inside: boolean, side: Side): void;
  /** Pulled off the panel while pressed; the press ends. */
  leave?(side: Side): void;
}

const RADIUS = 6;

export interface ButtonOptions {
  id: string;
  box: Box;
  label?: string;
  icon?: IconName | undefined;
  /** Of a switch: whether it is on. */
  on?: boolean;
  off?: boolean;
  run: () => void;
  /** The label stands beside the icon, not under it. */
  wide?: boolean;
  color?: ColorName;
}

export function button(options: ButtonOptions): Widget {
  const { id, box, off = false, run } = options;
  return {
    id,
    box,
    off,
    paint: (painter, look) => paintButton(painter, options, look),
    release: (_x, _y, inside) => {
      if (inside && !off) run();
    },
  };
}

function paintButton(painter: Painter, { box, label, icon, on, off, wide, color }: ButtonOptions, { hover, pressed }: Look): void {
  const { x, y, w, h } = box;
  const { context } = painter;
  context.save();
  if (off) context.globalAlpha = 0.4;
  if (!off) painter.fill(box, RADIUS, on ? "accent-soft" : pressed ? "line" : hover ? "hover" : "raised");
  if (hover && !off) painter.outline(box, RADIUS, "accent", 1);
  else if (on) painter.outline(box, RADIUS, "accent", 0.8);
  context.globalAlpha = off ? 0.4 : 1;
  const ink = color ?? (on ? "accent" : "text");
  const middle = y + h / 2;
  if (icon && label && !wide) {
    painter.icon(icon, x + w / 2, y + 0.38 * h, Math.min(0.42 * h, 20), ink);
    painter.text(label, x + w / 2, y + h - 10, { size: SMALL, color: ink, align: "center", width: w - 4 });
  } else if (icon && label) {
    painter.icon(icon, x + 15, middle, 16, ink);
    painter.text(label, x + 28, middle + 0.5, { size: SMALL, color: ink, width: w - 32 });
  } else if (icon) painter.icon(icon, x + w / 2, middle, Math.min(0.55 * h, 18), ink);
  else if (label) painter.text(label, x + w / 2, middle + 0.5, { size: h < 26 ? SMALL : TEXT - 1, color: ink, align: "center", width: w - 6 });
  context.restore();
}

/** Text that cannot be pressed. */
export function label(id: string, box: Box, text: string, options: { size?: number; color?: ColorName; bold?: boolean; align?: CanvasTextAlign; rows?: number } = {}): Widget {
  const { size = TEXT, color = "text", bold = false, align = "left", rows = 1 } = options;
  const x = align === "center" ? box.x + box.w / 2 : align === "right" ? box.x + box.w : box.x;
  return {
    id,
    box,
    off: true,
    paint: (painter) => {
      if (rows > 1) painter.lines(text, x, box.y + 0.6 * size, { size, color, align, width: box.w, most: rows });
      else painter.text(text, x, box.y + box.h / 2, { size, color, bold, align, width: box.w });
    },
  };
}

interface SliderOptions {
  id: string;
  box: Box;
  /** 0 … 1. */
  part: number;
  /** A range on the track that is marked: the interval of the value. */
  likely?: [number, number] | null;
  change: (part: number) => void;
  end?: () => void;
}

export function slider({ id, box, part, likely, change, end }: SliderOptions): Widget {
  const left = box.x + 7;
  const width = box.w - 14;
  const at = (x: number): number => Math.min(Math.max((x - left) / width, 0), 1);
  let value = part;
  const take = (x: number): void => change((value = at(x)));
  return {
    id,
    box,
    paint: (painter, { hover, pressed }) => {
      const y = box.y + box.h / 2;
      const track = { x: left, y: y - 2, w: width, h: 4 };
      painter.fill(track, 2, "line");
      if (likely) painter.fill({ x: left + likely[0] * width, y: y - 3.5, w: Math.max((likely[1] - likely[0]) * width, 2), h: 7 }, 3.5, "accent", 0.3);
      painter.fill({ ...track, w: value * width }, 2, "accent");
      const radius = pressed ? 8 : hover ? 7.5 : 6.5;
      painter.fill({ x: left + value * width - radius, y: y - radius, w: 2 * radius, h: 2 * radius }, radius, pressed || hover ? "accent" : "text");
    },
    press: take,
    move: take,
    release: () => end?.(),
  };
}
