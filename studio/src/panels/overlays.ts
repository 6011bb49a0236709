// SPDX-License-Identifier: MIT
import type { Parts } from "../parts";
import { element, show } from "./element";
import { t } from "../language";

/** Overlays of the scene: the legend of states, the loading bar, hints for an empty scene, and the lost connection. */
export class Overlays {
  readonly root: HTMLElement;
  private readonly legend = element(
    "div",
    { class: "legend", "data-testid": "legend", role: "note", "aria-label": t("Colours of states") },
    legendLine("active", t("active")),
    legendLine("wants", t("wants to sleep")),
    legendLine("asleep", t("asleep")),
  );
  private readonly loading = element("div", { class: "badge loading", role: "status", "data-testid": "loading" }, t("Loading models…"));
  private readonly advice = element(
    "div",
    { class: "advice", "data-testid": "empty-scene" },
    element("strong", {}, t("Nothing here yet")),
    element("p", {}, t("Drag a model or a primitive in from the left, drop a model file here, or open a scene with Ctrl+O.")),
  );
  private readonly lost = element(
    "div",
    { class: "lost", role: "alert", "data-testid": "connection-lost" },
    element("strong", {}, t("The server cannot be reached")),
    element("p", {}, t("Is “embody serve” still running? The Studio connects again by itself; what you changed so far is kept by the server.")),
  );
  private everConnected = false;

  constructor(private readonly parts: Pick<Parts, "preferences" | "server" | "document" | "playback" | "entities">) {
    this.root = element("div", { class: "overlays" }, this.legend, this.loading, this.advice, this.lost);
    const update = () => this.update();
    parts.server.opened.on(() => (this.everConnected = true));
    parts.server.changed.on(update);
    parts.playback.changed.on(update);
    parts.document.changed.on(update);
    parts.entities.loadingBegan.on(update);
    parts.entities.loaded.on(update);
    parts.preferences.changed.on(update);
    this.update();
  }

  private update(): void {
    const { parts } = this;
    const open = parts.server.isOpen;
    show(this.legend, parts.preferences.get("tint") && parts.playback.simulation.state !== "stopped");
    show(this.loading, parts.entities.loading > 0 || (!parts.server.ready && !this.everConnected));
    this.loading.textContent = parts.server.ready ? t("Loading {{count}} models…", { count: parts.entities.loading }) : t("Connecting…");
    // A new scene has only a floor.
    const { entities } = parts.document;
    const bare = entities.size <= 1 && [...entities.values()].every(({ shape, attributes }) => shape?.type === "plane" || attributes?.["kind"] === "static");
    show(this.advice, parts.server.ready && open && bare && parts.playback.simulation.state === "stopped");
    show(this.lost, parts.server.ready && !open);
    document.body.classList.toggle("disconnected", parts.server.ready && !open);
  }
}

function legendLine(state: string, label: string): HTMLElement {
  return element("span", { class: "legend-line" }, element("i", { class: `swatch ${state}` }), label);
}
