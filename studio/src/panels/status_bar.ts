// SPDX-License-Identifier: MIT
import type { Parts } from "../parts";
import { element, setText, show } from "./element";
import { countText, t } from "../language";

/** Without news for so long, a long command is taken as done. */
const PROGRESS_SHOWN_MS = 1200;

/** The line at the bottom: state and cost of the simulation, and the connection to the server. */
export class StatusBar {
  readonly root: HTMLElement;
  private readonly connection = element("span", { class: "connection", role: "status", "data-testid": "connection" });
  private readonly work = element("span", { class: "cell", role: "status", "data-testid": "stat-work" });
  private readonly loading = element("span", { class: "cell", role: "status", "data-testid": "stat-loading" });
  private readonly stop = element("button", { class: "text-button", "data-testid": "stop-work", onclick: () => void this.parts.server.command("catalog.stop", {}) }, t("Stop"));
  private workTimer = 0;
  private readonly cells = new Map<string, HTMLElement>();
  private lastFrames = 0;
  private lastLook = performance.now();

  constructor(private readonly parts: Pick<Parts, "server" | "playback" | "entities" | "view">) {
    const cell = (name: string, title: string, kind = ""): HTMLElement => {
      const made = element("span", { class: `cell ${kind}`, title, "data-testid": `stat-${name}` });
      this.cells.set(name, made);
      return made;
    };
    this.root = element(
      "footer",
      { class: "status-bar", "aria-label": t("Statistics"), "data-testid": "status-bar" },
      cell("state", t("State of the simulation"), "wide"),
      cell("hint", t("The simulation begins from the scene as it is now")),
      cell("time", t("Simulated time")),
      cell("active", t("How many of the movable things move; a heap of grains, a liquid, a cloth or a rope counts as one"), "active"),
      cell("wants", t("Things that are quiet and want to sleep"), "wants"),
      cell("asleep", t("Things asleep: they cost nothing until something touches them"), "asleep"),
      cell("points", t("Grains, drops of liquids and nodes of soft things")),
      cell("contacts", t("Contacts")),
      cell("step", t("Time the computer needs for one step of the simulation")),
      cell("rate", t("Simulated seconds in one second of yours")),
      cell("fps", t("Pictures drawn in the last second; idle: nothing changes, so nothing is drawn")),
      element("span", { class: "spacer" }),
      this.loading,
      this.work,
      this.stop,
      this.connection,
    );
    this.showWork("", false);
    this.showLoading();
    parts.entities.loadingBegan.on(() => this.showLoading());
    parts.entities.loaded.on(() => this.showLoading());
    parts.server.progress.on(({ client, done, total }) => this.showWork(t("Changing models: {{done}} of {{total}}", { done: countText(done), total: countText(total) }), client === parts.server.client));
    parts.server.catalogChanged.on(() => this.showWork("", false));
    parts.playback.measured.on(() => this.update());
    parts.playback.changed.on(() => this.update());
    parts.server.changed.on(() => this.update());
    setInterval(() => this.countFrames(), 1000);
    this.update();
  }

  /** Progress of a long command on the server; the client that started it can stop it. */
  private showWork(text: string, mayStop: boolean): void {
    setText(this.work, text);
    show(this.work, text !== "");
    show(this.stop, mayStop);
    clearTimeout(this.workTimer);
    if (text) this.workTimer = window.setTimeout(() => this.showWork("", false), PROGRESS_SHOWN_MS);
  }

  private showLoading(): void {
    const { loading, loadingOf } = this.parts.entities;
    show(this.loading, loading > 0);
    if (loading > 0) setText(this.loading, t("Loading models: {{done}} of {{total}}", { done: loadingOf - loading, total: loadingOf }));
  }

  private put(name: string, text: string): void {
    setText(this.cells.get(name)!, text);
  }

  private update(): void {
    const { server, playback } = this.parts;
    const { statistics, simulation } = playback;
    this.put("state", { stopped: t("Stopped"), playing: t("Playing"), paused: t("Paused") }[simulation.state]);
    this.put("time", `${Math.max(simulation.time, 0).toFixed(2)} s`);
    this.put("hint", this.parts.server.ready ? t("Press Space to play") : "");
    // Before the first step nothing is measured.
    const begun = simulation.state !== "stopped";
    for (const [name, cell] of this.cells) if (name !== "state" && name !== "fps") show(cell, begun === (name !== "hint"));
    // The rate of single steps would show how fast a person presses a key.
    show(this.cells.get("rate")!, simulation.state === "playing");
    this.put("active", statistics ? t("{{active}} of {{things}} active", { active: statistics.active, things: statistics.things }) : t("– active"));
    const points = statistics?.points ?? 0;
    this.put("points", t("{{count, number}} points", { count: points }));
    show(this.cells.get("points")!, begun && points > 0);
    this.put("wants", t("{{number}} want to sleep", { number: statistics?.wants_to_sleep ?? "–" }));
    this.put("asleep", t("{{number}} asleep", { number: statistics?.asleep ?? "–" }));
    this.put("contacts", t("{{number}} contacts", { number: statistics?.contacts ?? "–" }));
    this.put("step", statistics ? t("{{time}} ms a step", { time: statistics.step_ms.toFixed(2) }) : t("– ms a step"));
    this.put("rate", statistics ? t("{{factor}}× real time", { factor: statistics.real_time_factor.toFixed(2) }) : t("–× real time"));
    this.connection.dataset["state"] = server.isOpen ? "open" : "closed";
    setText(this.connection, server.isOpen ? [t("Connected"), server.version && `Embody ${server.version}`].filter(Boolean).join(" · ") : t("Not connected"));
  }

  private countFrames(): void {
    const { frames } = this.parts.view;
    const now = performance.now();
    this.put("fps", frames === this.lastFrames ? t("idle") : t("{{rate}} fps", { rate: Math.round(((frames - this.lastFrames) * 1000) / (now - this.lastLook)) }));
    this.lastFrames = frames;
    this.lastLook = now;
    if (this.parts.playback.playing) this.put("time", `${this.parts.playback.simulation.time.toFixed(2)} s`);
  }
}
