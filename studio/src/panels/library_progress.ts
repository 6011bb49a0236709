// SPDX-License-Identifier: MIT
import type { LibraryFill } from "../connection/messages";
import type { Parts } from "../parts";
import { element, setText, show } from "./element";
import { countText, t, translateServerText } from "../language";

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
    const counted = [t("{{done}} of {{total}}", { done: countText(done), total: countText(total) }), left].filter(Boolean).join(" · ");
    setText(this.text, t("Filling the library: {{progress}}", { progress: isAtWork ? counted : total > 0 ? t("the next catalogue is on its way") : t("looking for models") }));
    setText(this.file, isAtWork ? file : "");
    this.file.title = file;
  }

  private tellEnd({ state, added, skipped, failures, notes }: LibraryFill): void {
    const lights = skipped > 0 ? t("{{count}} light sources have no shape and were left out.", { count: skipped }) : "";
    const bad = failures.length > 0 ? t("{{count}} could not be read: {{files}}.", { count: failures.length, files: [...failures.slice(0, 3).map(({ path }) => path), ...(failures.length > 3 ? ["…"] : [])].join(", ") }) : "";
    const level = failures.length > 0 || notes.length > 0 ? "warning" : "info";
    const text = state === "done" ? t("The library is filled: {{count, number}} new models.", { count: added }) : t("Filling the library stopped.");
    this.parts.notices.tell({ level, text: [text, lights, bad].filter(Boolean).join(" "), ...(notes.length > 0 && { remedy: notes.map(translateServerText).join(" ") }) });
  }
}

/** "1 min left": a time for people, coarse where it is long; empty where it is not known. */
export function timeLeft(seconds: number | null): string {
  if (seconds === null) return "";
  if (seconds < 10) return t("a few seconds left");
  if (seconds < 55) return t("{{seconds}} s left", { seconds: Math.ceil(seconds / 10) * 10 });
  return t("{{minutes}} min left", { minutes: Math.ceil(seconds / 60) });
}
