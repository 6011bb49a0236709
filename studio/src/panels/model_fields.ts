// SPDX-License-Identifier: MIT
import { entityOf } from "../document/entity_of_model";
import type { Parts } from "../parts";
import { addInFront } from "../tools/ghost";
import { element, show } from "./element";
import { openHistory } from "./history";
import { modelCard } from "./model_card";
import { t } from "../language";

/** The model that was picked in the browser: its data, and actions on it. */
export class ModelFields {
  readonly root = element("section", { class: "entity", "data-testid": "model-fields", "aria-label": t("Model") });

  constructor(private readonly parts: Pick<Parts, "server" | "selection" | "picked" | "models" | "view">) {
    parts.picked.changed.on(() => this.update());
    parts.server.catalogChanged.on(() => this.update());
    this.update();
  }

  private update(): void {
    const { picked } = this.parts;
    const { model } = picked;
    show(this.root, model !== null);
    if (!model) return;
    this.root.replaceChildren(
      element("h2", { "data-testid": "model-name" }, model.name),
      modelCard(this.parts, model.key),
      element(
        "div",
        { class: "model-buttons" },
        element("button", { "data-testid": "model-add", onclick: () => void addInFront(this.parts, entityOf(model)) }, t("Add to the scene")),
        element("button", { "data-testid": "model-history", onclick: () => openHistory(this.parts, model) }, t("History…")),
      ),
      element("p", { class: "note" }, t("A model of the catalogue: what is changed here holds in every scene.")),
    );
  }
}
