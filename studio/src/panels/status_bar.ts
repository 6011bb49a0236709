// SPDX-License-Identifier: MIT
import type { Parts } from "../parts";
import { element, setText, show } from "./element";

/** Without news for so long, a long command is taken as done. */
const PROGRESS_SHOWN_MS = 1200;

/** The line at the bottom: state and cost of the simulation, and the connection to the server. */
export class StatusBar {
  readonly root: HTMLElement;
  private readonly connection = element("span", { class: "connection", role: "status", "data-testid": "connection" });
  private readonly work = element("span", { class: "cell", role: "status", "data-testid": "stat-work" });
  private readonly loading = element("span", { class: "cell", role: "status", "data-testid": "stat-loading" });
  private readonly stop = element("button", { class: "text-button", "data-testid": "stop-work", onclick: () => void this.parts.server.command("catalog.stop", {}) }, "Stop");
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
      { class: "status-bar", "aria-label": "Statistics", "data-testid": "status-bar" },
      cell("state", "State of the simulation", "wide"),
      cell("hint", "The simulation begins from the scene as it is now"),
      cell("time", "Simulated time"),
      cell("active", "How many of the movable things move; a heap of grains, a liquid, a cloth or a rope counts as one", "active"),
      cell("wants", "Things that are quiet and want to sleep", "wants"),
      cell("asleep", "Things asleep: they cost nothing until something touches them", "asleep"),
      cell("points", "Grains, drops of liquids and nodes of soft things"),
      cell("contacts", "Contacts"),
      cell("step", "Time the computer needs for one step of the simulation"),
      cell("rate", "Simulated seconds in one second of yours"),
      cell("fps", "Pictures drawn in the last second; idle: nothing changes, so nothing is drawn"),
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
    parts.server.progress.on(({ client, done, total }) => this.showWork(`Changing models: ${done.toLocaleString("en")} of ${total.toLocaleString("en")}`, client === parts.server.client));
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
    if (loading > 0) setText(this.loading, `Loading models: ${loadingOf - loading} of ${loadingOf}`);
  }

  private put(name: string, text: string): void {
    setText(this.cells.get(name)!, text);
  }

  private update(): void {
    const { server, playback } = this.parts;
    const { statistics, simulation } = playback;
    this.put("state", { stopped: "Stopped", playing: "Playing", paused: "Paused" }[simulation.state]);
    this.put("time", `${Math.max(simulation.time, 0).toFixed(2)} s`);
    this.put("hint", this.parts.server.ready ? "Press Space to play" : "");
    // Before the first step nothing is measured.
    const begun = simulation.state !== "stopped";
    for (const [name, cell] of this.cells) if (name !== "state" && name !== "fps") show(cell, begun === (name !== "hint"));
    // The rate of single steps would show how fast a person presses a key.
    show(this.cells.get("rate")!, simulation.state === "playing");
    this.put("active", statistics ? `${statistics.active} of ${statistics.things} active` : "– active");
    const points = statistics?.points ?? 0;
    this.put("points", `${points.toLocaleString("en")} points`);
    show(this.cells.get("points")!, begun && points > 0);
    this.put("wants", `${statistics?.wants_to_sleep ?? "–"} want to sleep`);
    this.put("asleep", `${statistics?.asleep ?? "–"} asleep`);
    this.put("contacts", `${statistics?.contacts ?? "–"} contacts`);
    this.put("step", statistics ? `${statistics.step_ms.toFixed(2)} ms a step` : "– ms a step");
    this.put("rate", statistics ? `${statistics.real_time_factor.toFixed(2)}× real time` : "–× real time");
    this.connection.dataset["state"] = server.isOpen ? "open" : "closed";
    setText(this.connection, server.isOpen ? `Connected${server.version ? ` · Embody ${server.version}` : ""}` : "Not connected");
  }

  private countFrames(): void {
    const { frames } = this.parts.view;
    const now = performance.now();
    this.put("fps", frames === this.lastFrames ? "idle" : `${Math.round(((frames - this.lastFrames) * 1000) / (now - this.lastLook))} fps`);
    this.lastFrames = frames;
    this.lastLook = now;
    if (this.parts.playback.playing) this.put("time", `${this.parts.playback.simulation.time.toFixed(2)} s`);
  }
}
