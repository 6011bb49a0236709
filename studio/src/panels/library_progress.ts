// SPDX-License-Identifier: MIT
import type { LibraryFill } from "../connection/messages";
import type { Parts } from "../parts";
import { element, setText, show } from "./element";

/** How far the server is with filling the library: there while it does that, and a notice at the end. */
export class LibraryProgress {
  readonly root: HTMLElement;
  private readonly bar = element("progress", { "aria-labelledby": "library-progress-text" });
  private readonly text = element("span", { id: "library-progress-text", "data-testid": "library-progress-text" });
  private readonly file = element("span", { class: "library-file", "data-testid": "library-progress-file" });
  private wasRunning = false;

  constructor(private readonly parts: Pick<Parts, "server" | "notices">) {
    this.root = element("div", { class: "library-progress", role: "status", "data-testid": "library-progress" }, this.bar, this.text, this.file);
    show(this.root, false);
    parts.server.filling.on((fill) => this.follow(fill));
  }

  private follow(fill: LibraryFill): void {
    const isRunning = fill.state === "running";
    show(this.root, isRunning);
    if (isRunning) this.draw(fill);
    else if (this.wasRunning) this.tellEnd(fill);
    this.wasRunning = isRunning;
  }

  private draw({ done, total, seconds_left, file }: LibraryFill): void {
    if (done < total) {
      this.bar.max = total;
      this.bar.value = done;
    } else this.bar.removeAttribute("value");
    const left = timeLeft(seconds_left);
    const isAtWork = done < total;
    const counted = `${done.toLocaleString("en")} of ${total.toLocaleString("en")}${left && ` · ${left}`}`;
    setText(this.text, `Filling the library: ${isAtWork ? counted : total > 0 ? "the next catalogue is on its way" : "looking for models"}`);
    setText(this.file, isAtWork ? file : "");
    this.file.title = file;
  }

  private tellEnd({ state, added, skipped, failures, notes }: LibraryFill): void {
    const lights = skipped > 0 ? ` ${skipped} light sources have no shape and were left out.` : "";
    const bad = failures.length > 0 ? ` ${failures.length} could not be read: ${failures.slice(0, 3).map(({ path }) => path).join(", ")}${failures.length > 3 ? ", …" : ""}.` : "";
    const level = failures.length > 0 || notes.length > 0 ? "warning" : "info";
    const text = state === "done" ? `The library is filled: ${added.toLocaleString("en")} new models.` : "Filling the library stopped.";
    this.parts.notices.tell({ level, text: `${text}${lights}${bad}`, ...(notes.length > 0 && { remedy: notes.join(" ") }) });
  }
}

/** "1 min left": a time for people, coarse where it is long; empty where it is not known. */
export function timeLeft(seconds: number | null): string {
  if (seconds === null) return "";
  if (seconds < 10) return "a few seconds left";
  if (seconds < 55) return `${Math.ceil(seconds / 10) * 10} s left`;
  return `${Math.ceil(seconds / 60)} min left`;
}
