// SPDX-License-Identifier: MIT
import type { TimeMark } from "../connection/messages";
import { element, setText, show } from "../panels/element";
import { Signal } from "../signal";
import { markText, timeText } from "./mark_text";
import type { Parts } from "../parts";
import { t } from "../language";

/** The shortest part of a take that can be zoomed to, s; and what is shown of a shorter take. */
const SHORTEST_S = 0.1;
const LEAST_SHOWN_S = 2;
const ZOOM_PER_NOTCH = 1.25;
/** Marks nearer to the pointer than this, pixels, are told of; so many of them by name. */
const REACH_PX = 5;
const MOST_TOLD = 4;
/** Pixels between two numbers of the ruler, at least. */
const RULER_PX = 70;
const ARROW_STEPS = 1;
const SHIFT_STEPS = 10;
const COLORS: Record<TimeMark["kind"], string> = { contact: "--dim", action: "--accent", rope_broke: "--error", sheet_tore: "--error", hand: "--wants", branch: "--accent" };

/** The take as a line: a ruler, marks, and the moment that is shown. Dragging on it scrubs. */
export class Track {
  readonly root: HTMLElement;
  /** The user wants to see this time, s. */
  readonly wanted = new Signal<number>();
  private readonly canvas = element("canvas", { class: "track-canvas" });
  private readonly tip = element("div", { class: "track-tip", role: "tooltip", "data-testid": "time-tip" });
  private first = 0;
  private last = LEAST_SHOWN_S;
  private isZoomed = false;
  private isAsked = false;
  private isDragging = false;

  constructor(private readonly parts: Pick<Parts, "document" | "playback" | "take" | "preferences">) {
    this.root = element("div", { class: "track", role: "slider", tabindex: 0, "aria-label": t("Time"), "data-testid": "time-track" }, this.canvas, this.tip);
    show(this.tip, false);
    new ResizeObserver(() => this.refresh()).observe(this.root);
    this.root.addEventListener("pointerdown", (event) => this.press(event));
    this.root.addEventListener("pointermove", (event) => this.move(event));
    this.root.addEventListener("pointerup", () => (this.isDragging = false));
    this.root.addEventListener("pointercancel", () => (this.isDragging = false));
    this.root.addEventListener("pointerleave", () => show(this.tip, false));
    this.root.addEventListener("wheel", (event) => this.zoom(event), { passive: false });
    this.root.addEventListener("dblclick", () => this.showAll());
    this.root.addEventListener("keydown", (event) => this.key(event));
    parts.preferences.changed.on(() => this.refresh());
  }

  /** The moment that is shown, s. */
  get now(): number {
    const { take, playback } = this.parts;
    return take.state.shown !== null && !playback.playing ? take.state.shown : Math.max(playback.simulation.time, take.state.start);
  }

  get end(): number {
    return Math.max(this.parts.take.state.end, this.parts.take.state.shown === null ? this.parts.playback.simulation.time : 0);
  }

  showAll(): void {
    this.isZoomed = false;
    this.refresh();
  }

  refresh(): void {
    if (this.isAsked) return;
    this.isAsked = true;
    requestAnimationFrame(() => {
      this.isAsked = false;
      this.draw();
    });
  }

  private fit(): void {
    const { start } = this.parts.take.state;
    const { end } = this;
    if (!this.isZoomed) {
      this.first = start;
      this.last = Math.max(end, start + LEAST_SHOWN_S);
      return;
    }
    // While it plays, what is shown stays in view.
    const width = this.last - this.first;
    const { now } = this;
    if (this.parts.playback.playing && (now > this.last || now < this.first)) {
      this.first = Math.max(start, now - width / 2);
      this.last = this.first + width;
    }
  }

  private x(time: number, width: number): number {
    return ((time - this.first) / (this.last - this.first)) * width;
  }

  private timeAt(clientX: number): number {
    const { left, width } = this.root.getBoundingClientRect();
    const time = this.first + ((clientX - left) / width) * (this.last - this.first);
    return Math.min(Math.max(time, this.parts.take.state.start), this.end);
  }

  private press(event: PointerEvent): void {
    if (event.button !== 0) return;
    this.root.setPointerCapture(event.pointerId);
    this.isDragging = true;
    this.wanted.emit(this.timeAt(event.clientX));
  }

  private move(event: PointerEvent): void {
    if (this.isDragging) this.wanted.emit(this.timeAt(event.clientX));
    this.showTip(event.clientX);
  }

  private showTip(clientX: number): void {
    const { left, width } = this.root.getBoundingClientRect();
    const at = clientX - left;
    const near = this.parts.take.marks.filter(({ time }) => Math.abs(this.x(time, width) - at) <= REACH_PX);
    const strongest = [...near].sort((a, b) => (b.impulse ?? Infinity) - (a.impulse ?? Infinity)).slice(0, MOST_TOLD);
    const lines = strongest.map((mark) => `${timeText(mark.time)}: ${markText(mark, this.parts.document)}`);
    if (near.length > strongest.length) lines.push(t("and {{number}} more", { number: near.length - strongest.length }));
    setText(this.tip, lines.length > 0 ? lines.join("\n") : timeText(this.timeAt(clientX)));
    show(this.tip, true);
    const half = this.tip.offsetWidth / 2;
    this.tip.style.left = `${Math.min(Math.max(at, half), Math.max(width - half, half))}px`;
  }

  private zoom(event: WheelEvent): void {
    event.preventDefault();
    const { start } = this.parts.take.state;
    const all = Math.max(this.end, start + LEAST_SHOWN_S) - start;
    const middle = this.timeAt(event.clientX);
    const before = this.last - this.first;
    if (event.shiftKey) {
      this.pan((event.deltaY / 800) * before);
      return;
    }
    const width = Math.min(Math.max(before * (event.deltaY > 0 ? ZOOM_PER_NOTCH : 1 / ZOOM_PER_NOTCH), SHORTEST_S), all);
    this.isZoomed = width < all;
    this.first = middle - ((middle - this.first) / before) * width;
    this.last = this.first + width;
    this.pan(0);
  }

  private pan(by: number): void {
    const { start } = this.parts.take.state;
    const width = this.last - this.first;
    this.first = Math.max(start, Math.min(this.first + by, Math.max(this.end, start + LEAST_SHOWN_S) - width));
    this.last = this.first + width;
    this.refresh();
  }

  private key(event: KeyboardEvent): void {
    const step = Math.max(this.parts.document.settings.time_step, 1 / 60) * (event.shiftKey ? SHIFT_STEPS : ARROW_STEPS);
    const times: Record<string, number> = {
      Home: this.parts.take.state.start,
      End: this.end,
      ArrowLeft: this.now - step,
      ArrowDown: this.now - step,
      ArrowRight: this.now + step,
      ArrowUp: this.now + step,
      PageUp: this.now - 60 * step,
      PageDown: this.now + 60 * step,
    };
    const time = times[event.key];
    if (time === undefined || event.ctrlKey || event.altKey || event.metaKey) return;
    event.preventDefault();
    this.wanted.emit(Math.min(Math.max(time, this.parts.take.state.start), this.end));
  }

  private draw(): void {
    const { clientWidth: width, clientHeight: height } = this.root;
    if (width === 0) return;
    this.fit();
    const { now, end } = this;
    const { start, shown } = this.parts.take.state;
    this.root.setAttribute("aria-valuemin", start.toFixed(3));
    this.root.setAttribute("aria-valuemax", end.toFixed(3));
    this.root.setAttribute("aria-valuenow", now.toFixed(3));
    this.root.setAttribute("aria-valuetext", shown === null ? t("{{now}} of {{end}}", { now: timeText(now), end: timeText(end) }) : t("{{now}} of {{end}}, looking back", { now: timeText(now), end: timeText(end) }));

    const ratio = devicePixelRatio;
    this.canvas.width = Math.round(width * ratio);
    this.canvas.height = Math.round(height * ratio);
    const pen = this.canvas.getContext("2d")!;
    pen.scale(ratio, ratio);
    const style = getComputedStyle(this.root);
    const color = (name: string) => style.getPropertyValue(name).trim();
    const top = 15;
    // What is recorded.
    pen.fillStyle = color("--raised");
    pen.fillRect(this.x(start, width), top, this.x(end, width) - this.x(start, width), height - top);
    pen.fillStyle = color("--accent-soft");
    pen.fillRect(this.x(start, width), top, this.x(now, width) - this.x(start, width), height - top);
    this.drawRuler(pen, width, height, color("--dim"), color("--line"));
    this.drawMarks(pen, width, height, color);
    const at = this.x(now, width);
    pen.fillStyle = color("--accent");
    pen.fillRect(at - 1, 4, 2, height - 4);
    pen.beginPath();
    pen.arc(at, 6, 4.5, 0, 7);
    pen.fill();
  }

  private drawRuler(pen: CanvasRenderingContext2D, width: number, height: number, text: string, line: string): void {
    const most = Math.max(1, Math.floor(width / RULER_PX));
    const rough = (this.last - this.first) / most;
    const power = 10 ** Math.floor(Math.log10(rough));
    const step = ([1, 2, 5, 10].find((factor) => factor * power >= rough) ?? 10) * power;
    const digits = Math.max(0, -Math.floor(Math.log10(step)));
    pen.font = "10px system-ui, sans-serif";
    pen.textBaseline = "top";
    for (let number = Math.ceil(this.first / step); number * step <= this.last; ++number) {
      const at = this.x(number * step, width);
      pen.fillStyle = line;
      pen.fillRect(at, 12, 1, height - 12);
      pen.fillStyle = text;
      pen.fillText((number * step).toFixed(digits), at + 3, 2);
    }
  }

  private drawMarks(pen: CanvasRenderingContext2D, width: number, height: number, color: (name: string) => string): void {
    const strongest = this.parts.take.marks.reduce((most, { impulse = 0 }) => Math.max(most, impulse), 1e-9);
    for (const mark of this.parts.take.marks) {
      const at = this.x(mark.time, width);
      if (at < 0 || at > width) continue;
      pen.fillStyle = color(COLORS[mark.kind]);
      if (mark.kind === "contact") {
        // By four powers of ten.
        const share = Math.max(0.12, 1 + Math.log10(Math.max(mark.impulse ?? 0, 1e-9) / strongest) / 4);
        pen.fillRect(at - 0.75, height - share * (height - 18), 1.5, share * (height - 18));
      } else {
        pen.beginPath();
        pen.moveTo(at, 17);
        pen.lineTo(at + 4.5, 22);
        pen.lineTo(at, 27);
        pen.lineTo(at - 4.5, 22);
        pen.fill();
      }
    }
  }
}
