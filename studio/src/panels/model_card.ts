// SPDX-License-Identifier: MIT
import type { Parts } from "../parts";
import { element } from "./element";

/** A model's name, author and licence. */
export function modelCard(parts: Pick<Parts, "models">, key: string): HTMLElement {
  const card = element("div", { class: "model-card", "data-testid": "model-card" });
  parts.models.summary(key).then((model) => {
    const size = model.size.map((length) => length.toPrecision(3)).join(" × ");
    const lines = [[model.category, model.subcategory].filter(Boolean).join(" / "), `${size} m, ${model.triangles.toLocaleString("en")} triangles`];
    lines.push([model.author && `by ${model.author}`, model.licence].filter(Boolean).join(", "));
    card.append(
      element("img", { src: parts.models.thumbnail(model), alt: "" }),
      element("div", {}, ...lines.filter(Boolean).map((line) => element("p", { class: "note", title: line }, line))),
    );
  }, () => card.append(element("p", { class: "note" }, `The model ${key} is not in the database`)));
  return card;
}
