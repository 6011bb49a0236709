// SPDX-License-Identifier: MIT
import type { Parts } from "../parts";
import type { Signal } from "../signal";
import { element } from "./element";
import { t } from "../language";

type TourParts = Pick<Parts, "preferences" | "server" | "document" | "playback" | "selection">;

interface Step {
  title: string;
  text: string;
  /** What the step is about, for a ring around it; by its data-testid. */
  at: string;
}

const STEPS: readonly Step[] = [
  { title: t("Bring something in"), text: t("Drag a model from the list on the left into the scene. The ghost shows where it comes to stand."), at: "model-grid" },
  { title: t("Let it go"), text: t("Press play, or Space. Everything falls, rolls and swings as what it is made of."), at: "simulation.play" },
  { title: t("Take hold of it"), text: t("While it plays, drag a thing with the mouse: you pull at the point that you pressed."), at: "canvas" },
  { title: t("See what it is"), text: t("Click on a thing. On the right is what it weighs and is made of, where each value comes from, and how to change it."), at: "properties" },
];

/** Four steps for whoever is here for the first time; each goes on by itself once it is done. */
export class Tour {
  readonly root = element("section", { class: "tour", role: "region", "aria-label": t("First steps"), "data-testid": "tour", hidden: true });
  private step = -1;
  private things = 0;

  constructor(
    private readonly parts: TourParts,
    grabbed: Signal<void>,
  ) {
    const { document, playback, selection, server, preferences } = parts;
    document.changed.on(({ all }) => {
      const added = !all && document.entities.size > this.things;
      this.things = document.entities.size;
      if (added) this.done(0);
    });
    playback.changed.on(() => playback.playing && this.done(1));
    grabbed.on(() => this.done(2));
    selection.changed.on(() => selection.indices.length > 0 && this.done(3));
    // Once the scene is there; `?tour=no` is for visits by programs.
    const end = server.changed.on(() => {
      if (!server.ready) return;
      end();
      const wanted = new URLSearchParams(location.search).get("tour") !== "no";
      if (wanted && !preferences.get("toured")) this.begin();
    });
  }

  begin(): void {
    this.go(0);
  }

  private done(step: number): void {
    if (this.step === step) this.go(step + 1);
  }

  private go(step: number): void {
    this.step = step;
    for (const ringed of document.querySelectorAll(".tour-ring")) ringed.classList.remove("tour-ring");
    const now = STEPS[step];
    this.root.hidden = !now;
    if (!now) {
      this.step = -1;
      this.parts.preferences.set("toured", true);
      return;
    }
    document.querySelector(`[data-testid="${now.at}"]`)?.classList.add("tour-ring");
    const isLast = step === STEPS.length - 1;
    this.root.replaceChildren(
      element("p", { class: "tour-count", "aria-live": "polite" }, t("{{done}} of {{total}}", { done: step + 1, total: STEPS.length })),
      element("h3", {}, now.title),
      element("p", {}, now.text),
      element(
        "div",
        { class: "card-buttons" },
        element("button", { "data-testid": "tour-skip", onclick: () => this.go(STEPS.length) }, t("Skip the tour")),
        element("button", { class: "primary", "data-testid": "tour-next", onclick: () => this.go(step + 1) }, isLast ? t("Done") : t("Next")),
      ),
    );
  }
}
