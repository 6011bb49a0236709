// SPDX-License-Identifier: MIT
import { dialogButtons, openDialog } from "../panels/dialogs";
import { element, setText, show } from "../panels/element";
import type { Parts } from "../parts";
import { download } from "./download";
import { t } from "../language";
import type { Recording } from "./recording";

/** Longest side of a film of what one does, pixels: more is slow to encode while one works. */
const LONGEST_SIDE = 1920;

type Needed = Pick<Parts, "notices" | "document" | "playback" | "view">;

/** Records what the user does as a film: asks how, shows that it runs, and saves it. */
export class Recorder {
  /** Over the scene while it runs. */
  readonly root: HTMLElement;
  private readonly length = element("span", { class: "recording-length" });
  private recording: Recording | null = null;

  constructor(private readonly parts: Needed) {
    this.root = element(
      "div",
      { class: "recording", role: "status", "data-testid": "recording" },
      element("i", { class: "recording-dot" }),
      t("Recording"),
      this.length,
      element("button", { class: "text-button", "data-testid": "recording-end", onclick: () => void this.end() }, t("Stop and save")),
    );
    show(this.root, false);
    setInterval(() => this.showLength(), 500);
  }

  get isRunning(): boolean {
    return this.recording !== null;
  }

  /** Asks how to record, and begins. */
  open(): void {
    const pace = element(
      "select",
      { "aria-label": t("Pace"), "data-testid": "record-pace" },
      element("option", { value: "clock" }, t("as it was")),
      element("option", { value: "smooth" }, t("smooth: pauses are cut short")),
    );
    const text = element("input", { type: "text", maxlength: 80, "aria-label": t("Text over the film"), "data-testid": "record-text" });
    const tells = element("input", { type: "checkbox", checked: true, "data-testid": "record-tells" });
    const note = element("p", { class: "note", role: "status" }, t("The scene is filmed with the pointer, as you see it, until you press Stop."));
    const form = element(
      "form",
      {
        class: "film-form",
        onsubmit: async (event: Event) => {
          event.preventDefault();
          const fault = await this.begin(pace.value === "smooth", tells.checked, text.value.trim());
          if (fault) setText(note, fault);
          else dialog.close();
        },
      },
      element("label", { class: "film-row" }, element("span", {}, t("Pace")), pace),
      element("label", { class: "film-row" }, element("span", {}, t("Text")), text),
      element("label", { class: "option" }, tells, element("span", {}, t("Say what is done"))),
      note,
      dialogButtons(element("button", { type: "button", onclick: () => dialog.close() }, t("Cancel")), element("button", { class: "primary", type: "submit", "data-testid": "record-start" }, t("Record"))),
    );
    const dialog = openDialog(t("Record what I do"), "record-dialog", form);
  }

  /** Ends the recording and saves its film. */
  async end(): Promise<void> {
    const { recording } = this;
    if (!recording) return;
    this.recording = null;
    show(this.root, false);
    try {
      const film = await recording.end();
      download(film, `${this.parts.document.title || "scene"}.webm`);
      this.parts.notices.tell({ level: "info", text: t("The film is among your downloads ({{size}} MB)", { size: (film.size / 1e6).toFixed(1) }) });
    } catch (error) {
      this.parts.notices.tell({ level: "error", text: t("The recording could not be saved: {{reason}}", { reason: (error as Error).message }) });
    }
  }

  /** Begins a film of the size that the scene has on the page; why not, or null. */
  private async begin(isSmooth: boolean, tells: boolean, text: string): Promise<string | null> {
    const { canvas } = this.parts.view;
    const shown = [canvas.clientWidth * devicePixelRatio, canvas.clientHeight * devicePixelRatio];
    const scale = Math.min(1, LONGEST_SIDE / Math.max(...shown));
    // Encoders want even sides.
    const [width, height] = shown.map((side) => 2 * Math.max(8, Math.round((side * scale) / 2))) as [number, number];
    // The encoder's part of the page is loaded by who makes films.
    const { filmHindrance } = await import("./film_writer");
    const hindrance = await filmHindrance(width, height);
    if (hindrance) return hindrance;
    const { Recording } = await import("./recording");
    this.recording = await Recording.begin(this.parts, { width, height, isSmooth, tells, text }, () => void this.end());
    show(this.root, true);
    this.showLength();
    return null;
  }

  private showLength(): void {
    if (!this.recording) return;
    const seconds = Math.floor(this.recording.seconds);
    setText(this.length, `${Math.floor(seconds / 60)}:${String(seconds % 60).padStart(2, "0")}`);
  }
}
