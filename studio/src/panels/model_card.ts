// SPDX-License-Identifier: MIT
import type { Parts } from "../parts";
import { element } from "./element";
import { t, translateServerText } from "../language";

/** A model's name, author and licence. */
export function modelCard(parts: Pick<Parts, "models">, key: string): HTMLElement {
  const card = element("div", { class: "model-card", "data-testid": "model-card" });
  parts.models.summary(key).then((model) => {
    const size = model.size.map((length) => length.toPrecision(3)).join(" × ");
    const lines = [[model.category, model.subcategory].filter(Boolean).map(translateServerText).join(" / "), t("{{size}} m, {{count, number}} triangles", { size, count: model.triangles })];
    lines.push([model.author && t("by {{author}}", { author: model.author }), model.licence].filter(Boolean).join(", "));
    card.append(
      element("img", { src: parts.models.thumbnail(model), alt: "" }),
      element("div", {}, ...lines.filter(Boolean).map((line) => element("p", { class: "note", title: line }, line))),
    );
  }, () => card.append(element("p", { class: "note" }, t("The model {{key}} is not in the database", { key }))));
  return card;
}
