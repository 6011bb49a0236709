// SPDX-License-Identifier: MIT
import type { Studio } from "../studio";
import { element, show } from "./element";

/** What lies over the scene: the legend of states, loading, an empty scene's advice, and the lost connection. */
export class Overlays {
  readonly root: HTMLElement;
  private readonly legend = element(
    "div",
    { class: "legend", "data-testid": "legend", role: "note", "aria-label": "Colours of states" },
    legendLine("active", "active"),
    legendLine("wants", "wants to sleep"),
    legendLine("asleep", "asleep"),
  );
  private readonly loading = element("div", { class: "badge loading", role: "status", "data-testid": "loading" }, "Loading models…");
  private readonly advice = element(
    "div",
    { class: "advice", "data-testid": "empty-scene" },
    element("strong", {}, "Nothing here yet"),
    element("p", {}, "Drag a model or a primitive in from the left, drop a model file here, or open a scene with Ctrl+O."),
  );
  private readonly lost = element(
    "div",
    { class: "lost", role: "alert", "data-testid": "connection-lost" },
    element("strong", {}, "The server cannot be reached"),
    element("p", {}, "Is “embody serve” still running? The Studio connects again by itself; what you changed so far is kept by the server."),
  );
  private everConnected = false;

  constructor(private readonly studio: Studio) {
    this.root = element("div", { class: "overlays" }, this.legend, this.loading, this.advice, this.lost);
    const update = () => this.update();
    studio.connection.opened.on(() => (this.everConnected = true));
    studio.connectionChanged.on(update);
    studio.simulationChanged.on(update);
    studio.document.changed.on(update);
    studio.entities.loaded.on(update);
    studio.preferences.changed.on(update);
    this.update();
  }

  private update(): void {
    const { studio } = this;
    const open = studio.connection.isOpen;
    show(this.legend, studio.preferences.get("tint") && studio.simulation.state !== "stopped");
    show(this.loading, studio.entities.loading > 0 || (!studio.ready && !this.everConnected));
    this.loading.textContent = studio.ready ? `Loading ${studio.entities.loading} models…` : "Connecting…";
    // A new scene has a floor and nothing else.
    const { entities } = studio.document;
    const bare = entities.size <= 1 && [...entities.values()].every(({ shape, attributes }) => shape?.type === "plane" || attributes?.["kind"] === "static");
    show(this.advice, studio.ready && open && bare && studio.simulation.state === "stopped");
    show(this.lost, studio.ready && !open);
    document.body.classList.toggle("disconnected", studio.ready && !open);
  }
}

function legendLine(state: string, label: string): HTMLElement {
  return element("span", { class: "legend-line" }, element("i", { class: `swatch ${state}` }), label);
}
