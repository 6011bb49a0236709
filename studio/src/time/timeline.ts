// SPDX-License-Identifier: MIT
import { element, setText, show } from "../panels/element";
import type { Parts } from "../parts";
import type { UserAction } from "../tools/actions";
import { icon } from "../tools/icons";
import { timeText } from "./mark_text";
import { Plots } from "./plots";
import { Track } from "./track";
import { t } from "../language";

/** Marks are asked for at most this often, ms. */
const MARKS_MS = 400;
const RATES: readonly { rate: number; label: string }[] = [
  { rate: 2, label: "2×" },
  { rate: 1, label: "1×" },
  { rate: 0.5, label: "½×" },
  { rate: 0.25, label: "¼×" },
  { rate: 0.1, label: "⅒×" },
  { rate: 0.05, label: "1⁄20×" },
];

/** The bar over the lower edge of the scene, which it does not move when it appears: what has run, as a line to look back on, and what can be done with a moment of it. */
export class Timeline {
  readonly root: HTMLElement;
  readonly track: Track;
  readonly plots: Plots;
  private readonly time = element("span", { class: "time-now", "data-testid": "time-now" });
  private readonly badge = element("span", { class: "time-badge", role: "status", "data-testid": "time-badge" }, t("Looking back, for everybody"));
  private readonly rate = element("select", { "aria-label": t("Speed"), title: t("Speed: simulated seconds in one of yours"), "data-testid": "time-rate" });
  private readonly play = element("button", { class: "tool-button", "data-testid": "time-play" });
  private readonly body: HTMLElement;
  private readonly fold = element("button", { class: "tool-button", "data-testid": "time-fold" });
  private isSeeking = false;
  private sought: number | null = null;
  private marksTimer = 0;

  constructor(
    private readonly parts: Pick<Parts, "server" | "document" | "playback" | "take" | "selection" | "preferences">,
    private readonly actions: readonly UserAction[],
  ) {
    this.track = new Track(parts);
    this.track.wanted.on((time) => void this.seek(time));
    this.plots = new Plots(parts);
    this.plots.wanted.on((time) => void this.seek(time));
    this.rate.append(...RATES.map(({ rate, label }) => element("option", { value: rate }, label)));
    this.rate.addEventListener("change", () => void parts.server.command("simulation.set_rate", { rate: Number(this.rate.value) }));
    this.play.addEventListener("click", () => this.find("simulation.play")?.run());
    this.fold.addEventListener("click", () => parts.preferences.set("timelineFolded", !parts.preferences.get("timelineFolded")));
    const button = (name: string, label: string, symbol: Parameters<typeof icon>[0], run: () => void) =>
      element("button", { class: "tool-button", title: label, "aria-label": label, "data-testid": name, onclick: run }, icon(symbol));
    this.body = element("div", { class: "track-frame" }, this.track.root);
    this.root = element(
      "section",
      { class: "timeline", "aria-label": t("Time"), "data-testid": "timeline" },
      element(
        "div",
        { class: "time-row" },
        button("time-first", t("To the beginning (Home on the line)"), "reset", () => void this.seek(parts.take.state.start)),
        button("time-back", t("One step back (left arrow on the line)"), "stepBack", () => void this.seek(this.track.now - this.step)),
        this.play,
        button("time-forth", t("One step on (right arrow on the line)"), "stepOn", () => void this.stepOn()),
        button("time-last", t("To the end: what is now (End on the line)"), "toEnd", () => void this.seek(this.track.end)),
        this.time,
        this.rate,
        element("span", { class: "spacer" }),
        ...["time.branch", "time.keep", "time.plots", "time.film"].flatMap((id) => this.find(id) ?? []).map((action) => this.textButton(action)),
        this.fold,
      ),
      this.body,
      this.badge,
    );
    // What else lies over the scene makes room for it.
    new ResizeObserver(() => this.root.parentElement?.style.setProperty("--timeline", `${this.root.offsetHeight}px`)).observe(this.root);
    const update = () => this.update();
    parts.take.changed.on(update);
    parts.playback.changed.on(update);
    parts.playback.measured.on(update);
    parts.preferences.changed.on(update);
    parts.take.marked.on(() => this.askMarks());
    this.update();
  }

  /** New poses arrived: the clock has gone on. */
  tick(): void {
    if (this.root.hidden) return;
    this.showTime();
    this.track.refresh();
    this.plots.tick();
  }

  /** Shows everybody this time; of many wishes only the newest counts. */
  async seek(time: number): Promise<void> {
    this.sought = Math.max(time, 0);
    if (this.isSeeking) return;
    this.isSeeking = true;
    while (this.sought !== null) {
      const wanted = this.sought;
      this.sought = null;
      await this.parts.server.command("time.seek", { time: wanted });
    }
    this.isSeeking = false;
  }

  private get step(): number {
    return Math.max(this.parts.document.settings.time_step, 1 / 60);
  }

  private async stepOn(): Promise<void> {
    if (this.parts.take.state.shown === null) await this.parts.server.command("simulation.step", { count: 1 });
    else await this.seek(this.track.now + this.step);
  }

  private find(id: string): UserAction | undefined {
    return this.actions.find((action) => action.id === id);
  }

  private textButton(action: UserAction): HTMLElement {
    const made = element("button", { class: "time-button", title: action.label, "data-testid": action.id, onclick: () => action.run() }, action.icon ? icon(action.icon) : null, action.short ?? action.label);
    const refresh = () => {
      made.disabled = !(action.possible?.() ?? true);
      if (action.on) made.setAttribute("aria-pressed", String(action.on()));
    };
    this.parts.take.changed.on(refresh);
    this.parts.preferences.changed.on(refresh);
    refresh();
    return made;
  }

  private askMarks(): void {
    this.marksTimer ||= window.setTimeout(() => void this.takeMarks(), MARKS_MS);
  }

  private async takeMarks(): Promise<void> {
    const told = this.parts.server.isOpen ? await this.parts.server.command("time.marks", {}) : undefined;
    this.marksTimer = 0;
    if (!told) return;
    this.parts.take.setMarks(told.marks);
    if (told.revision !== this.parts.take.state.marks) this.askMarks();
  }

  private showTime(): void {
    setText(this.time, t("{{now}} of {{end}}", { now: timeText(this.track.now), end: timeText(this.track.end) }));
  }

  private update(): void {
    const { take, playback, preferences } = this.parts;
    show(this.root, take.isThere);
    const isFolded = preferences.get("timelineFolded");
    show(this.body, !isFolded);
    this.fold.replaceChildren(icon(isFolded ? "up" : "down"));
    this.fold.title = isFolded ? t("Unfold the line of time") : t("Fold the line of time");
    this.fold.setAttribute("aria-label", this.fold.title);
    this.fold.setAttribute("aria-expanded", String(!isFolded));
    show(this.badge, take.state.shown !== null);
    this.play.replaceChildren(icon(playback.playing ? "pause" : "play"));
    const label = playback.playing ? t("Pause") : take.state.shown === null ? t("Play") : t("Play from here");
    this.play.title = `${label} (Space)`;
    this.play.setAttribute("aria-label", label);
    const rate = playback.simulation.rate ?? 1;
    const known = RATES.find((each) => Math.abs(each.rate - rate) < 1e-9);
    this.rate.value = known ? String(known.rate) : "";
    this.showTime();
    this.track.refresh();
    this.plots.tick();
  }
}
