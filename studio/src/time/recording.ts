// SPDX-License-Identifier: MIT
import type { Parts } from "../parts";
import { t, translateServerText } from "../language";
import { drawBox, drawCaption } from "./caption";
import { FilmWriter } from "./film_writer";

/** Pictures a second at most. */
export const RECORDING_FPS = 24;
/** Where nothing is done for so long, s, that is a pause; where pauses are cut it lasts at most so long in the film. */
const PAUSE_S = 0.6;
const CUT_PAUSE_S = 1;
/** What was done is told for so long, s of the film. */
const TOLD_S = 2.5;
/** A film is made in memory, so that it has an end, s. */
const LONGEST_S = 3600;
/** Height of the pointer, part of the picture's height, and its outline on a grid of 12 × 19. */
const POINTER = 1 / 26;
const ARROW = new Path2D("M0 0V16.5L3.8 13.2 6.3 19 9 17.9 6.5 12.2H11.6Z");

/** What is recorded. */
export interface RecordingPlan {
  width: number;
  height: number;
  /** Pauses are cut short, and every picture that is drawn lasts as long as on a fast computer; not while the scene plays. */
  isSmooth: boolean;
  /** Tells what was done, by its name in the list of undo. */
  tells: boolean;
  /** Written over it all the time; empty: nothing. */
  text: string;
}

type Needed = Pick<Parts, "document" | "playback" | "view">;

/** Films the scene as it is seen while the user works: the drawn picture, the pointer, sizes, and what was done. */
export class Recording {
  /** Length of the film so far, s. */
  seconds = 0;
  private readonly scene: OffscreenCanvas;
  private readonly endings: (() => void)[] = [];
  private pointer: { x: number; y: number; pressed: boolean } | null = null;
  private told: { text: string; until: number } = { text: "", until: 0 };
  private undo: string | null;
  private redo: string | null;
  private pictures = 0;
  private taken = performance.now();
  private timer = 0;
  private adding: Promise<void> | null = null;
  /** Something has changed since the last picture was taken; before that nothing was done for so long, s. */
  private isOld = false;
  private idle = 0;
  private isScene = false;
  private fault: Error | null = null;

  private constructor(
    private readonly parts: Needed,
    private readonly plan: RecordingPlan,
    private readonly film: OffscreenCanvas,
    private readonly writer: FilmWriter,
    private readonly full: () => void,
  ) {
    const { view, document: scene } = parts;
    this.scene = new OffscreenCanvas(plan.width, plan.height);
    this.undo = scene.undo;
    this.redo = scene.redo;
    const follow = (event: PointerEvent): void => {
      this.pointer = { x: event.clientX, y: event.clientY, pressed: event.buttons !== 0 };
      // A picture may take long to draw: only what the hand waits is a pause.
      if (!this.isOld) this.idle = (performance.now() - this.taken) / 1000;
      this.takeSoon();
    };
    for (const kind of ["pointermove", "pointerdown", "pointerup"] as const) {
      addEventListener(kind, follow, { capture: true });
      this.endings.push(() => removeEventListener(kind, follow, { capture: true }));
    }
    this.endings.push(view.afterFrame.on(() => this.copyScene()), scene.historyChanged.on(() => this.tell()), scene.changed.on(() => this.tell()));
    view.invalidate();
  }

  /** Begins; `full` is called when the film is as long as films may be. */
  static async begin(parts: Needed, plan: RecordingPlan, full: () => void): Promise<Recording> {
    const film = new OffscreenCanvas(plan.width, plan.height);
    film.getContext("2d", { alpha: false });
    return new Recording(parts, plan, film, await FilmWriter.open(film, RECORDING_FPS), full);
  }

  /** Ends with the picture that is seen now, and gives the film. */
  async end(): Promise<Blob> {
    for (const ending of this.endings.splice(0)) ending();
    clearTimeout(this.timer);
    await this.adding;
    if (!this.isOld) this.idle = (performance.now() - this.taken) / 1000;
    await this.take();
    if (this.fault) throw this.fault;
    return this.writer.finish();
  }

  /** The drawn picture can only be read just after it was drawn. */
  private copyScene(): void {
    const { canvas, renderer } = this.parts.view;
    if (renderer.xr.isPresenting) return;
    const pen = this.scene.getContext("2d", { alpha: false })!;
    const { x, y, width, height } = this.frame();
    pen.imageSmoothingQuality = "high";
    pen.clearRect(0, 0, this.scene.width, this.scene.height);
    pen.drawImage(canvas, x, y, width, height);
    this.isScene = true;
    this.takeSoon();
  }

  /** Where the page's picture lies in the film's: as large as it can, and whole. */
  private frame(): { x: number; y: number; width: number; height: number; scale: number } {
    const { clientWidth, clientHeight } = this.parts.view.canvas;
    const { width, height } = this.plan;
    const scale = Math.min(width / clientWidth, height / clientHeight);
    return { x: (width - clientWidth * scale) / 2, y: (height - clientHeight * scale) / 2, width: clientWidth * scale, height: clientHeight * scale, scale };
  }

  private tell(): void {
    const { undo, redo } = this.parts.document;
    if (undo === this.undo && redo === this.redo) return;
    const isUndone = redo !== null && redo !== this.redo && redo === this.undo;
    const done = translateServerText((isUndone ? redo : undo) ?? "");
    const text = isUndone ? t("Undo: {{what}}", { what: done }) : done;
    [this.undo, this.redo] = [undo, redo];
    if (!this.plan.tells || !text) return;
    this.told = { text, until: this.seconds + TOLD_S };
    this.takeSoon();
  }

  private takeSoon(): void {
    this.isOld = true;
    if (this.timer || this.adding || !this.isScene) return;
    const wait = 1000 / RECORDING_FPS - (performance.now() - this.taken);
    this.timer = window.setTimeout(() => void this.take(), Math.max(0, wait));
  }

  /** Adds what is seen now to the film. */
  private async take(): Promise<void> {
    this.timer = 0;
    this.isOld = false;
    const now = performance.now();
    if (this.pictures > 0) this.seconds += this.lasted((now - this.taken) / 1000);
    this.taken = now;
    ++this.pictures;
    this.compose();
    this.adding = this.writer.add(this.seconds, 1 / RECORDING_FPS).catch((error: Error) => void (this.fault ??= error));
    await this.adding;
    this.adding = null;
    if (this.seconds > LONGEST_S || this.fault) this.full();
    else if (this.isOld && this.endings.length > 0) this.takeSoon();
  }

  /** How long what took so long lasts in the film, s. */
  private lasted(elapsed: number): number {
    const { idle } = this;
    this.idle = 0;
    if (!this.plan.isSmooth || this.parts.playback.playing) return Math.max(elapsed, 1 / RECORDING_FPS);
    return idle < PAUSE_S ? 1 / RECORDING_FPS : Math.min(idle, CUT_PAUSE_S);
  }

  private compose(): void {
    const { film, plan } = this;
    const pen = film.getContext("2d")!;
    pen.drawImage(this.scene, 0, 0);
    const canvas = this.parts.view.canvas.getBoundingClientRect();
    const { x, y, scale } = this.frame();
    const size = Math.round(plan.height / 40);
    pen.font = `${size}px system-ui, sans-serif`;
    for (const label of document.querySelectorAll<HTMLElement>(".measure-label:not([hidden])")) {
      const box = label.getBoundingClientRect();
      drawBox(pen, label.textContent ?? "", x + (box.left - canvas.left) * scale, y + (box.top - canvas.top) * scale, size, plan.width);
    }
    const told = this.seconds < this.told.until ? this.told.text : "";
    drawCaption(film, [plan.text, told].filter(Boolean).join(" · "));
    if (this.pointer) this.drawPointer(pen, x + (this.pointer.x - canvas.left) * scale, y + (this.pointer.y - canvas.top) * scale, this.pointer.pressed);
  }

  private drawPointer(pen: OffscreenCanvasRenderingContext2D, x: number, y: number, isPressed: boolean): void {
    const height = this.plan.height * POINTER;
    pen.save();
    pen.translate(x, y);
    if (isPressed) {
      pen.beginPath();
      pen.arc(0, 0, 0.55 * height, 0, 2 * Math.PI);
      pen.fillStyle = "rgb(63 140 255 / 45%)";
      pen.fill();
    }
    pen.scale(height / 19, height / 19);
    pen.fillStyle = "#fff";
    pen.strokeStyle = "#000";
    pen.lineWidth = 1.4;
    pen.fill(ARROW);
    pen.stroke(ARROW);
    pen.restore();
  }
}
