// SPDX-License-Identifier: MIT
import type { ModelSummary } from "../connection/messages";
import type { Parts } from "../parts";
import { addInFront } from "../tools/ghost";
import { PRIMITIVES, type Primitive } from "../tools/primitives";
import type { DragIn } from "./drag_in";
import { element, setText, show } from "./element";
import { ModelGrid } from "./model_grid";
import { countText, t, translateServerText } from "../language";

const SEARCH_DELAY_MS = 150;
/** While the library fills, models that have come are shown at most so often. */
const FILL_SHOWN_MS = 2000;
const ALL = "";
/** Of a category so many are compared. */
const MOST_ALIKE = 200;
const FAVOURITES = " favourites";
const RECENT = " recent";
const LISTED_BY = ["category", "subcategory", "kind"];

/** The left panel: models that can be added to the scene. */
export class ModelBrowser {
  readonly root: HTMLElement;
  private readonly words = element("input", {
    type: "search",
    placeholder: t("Search models"),
    "aria-label": t("Search models"),
    "data-testid": "search",
    oninput: () => this.searchSoon(),
    onkeydown: (event: KeyboardEvent) => this.wordsKey(event),
  });
  private readonly category = element("select", {
    "aria-label": t("Category"),
    "data-testid": "category",
    onchange: () => this.search(),
  });
  private readonly count = element("p", { class: "result-count", role: "status", "data-testid": "result-count" });
  private readonly empty = element("div", { class: "empty", "data-testid": "empty-result" });
  private readonly grid: ModelGrid;
  private timer = 0;
  private fillTimer = 0;
  private shownDone = 0;

  constructor(
    private readonly parts: Pick<Parts, "preferences" | "server" | "selection" | "picked" | "found" | "models" | "view">,
    private readonly dragIn: DragIn,
  ) {
    this.grid = new ModelGrid(parts, dragIn);
    this.grid.counted.on((total) => this.showCount(total));
    this.grid.used.on((model) => this.remember(model));
    this.grid.likeWanted.on((model) => void this.showLike(model));
    dragIn.added.on((model) => this.remember(model));
    this.root = element(
      "div",
      { class: "browser" },
      element("div", { class: "browser-search" }, this.words, this.category),
      this.primitives(),
      this.count,
      this.empty,
      this.grid.root,
    );
    show(this.empty, false);
    parts.server.changed.on(() => {
      if (parts.server.isOpen) this.refresh();
    });
    parts.server.filling.on(({ done, state }) => this.followFill(done, state !== "running"));
    // Categories and search use these attributes, so that the results may have changed.
    parts.server.catalogChanged.on(({ attributes }) => {
      if (!attributes.some((name) => LISTED_BY.includes(name))) return;
      void this.loadCategories();
      this.grid.renew();
    });
  }

  /** Shows models that have come, now and then, and at the end. */
  private followFill(done: number, isOver: boolean): void {
    if (done === this.shownDone && !isOver) return;
    this.shownDone = done;
    if (isOver) clearTimeout(this.fillTimer);
    if (this.fillTimer && !isOver) return;
    this.fillTimer = window.setTimeout(
      () => {
        this.fillTimer = 0;
        void this.loadCategories();
        void this.grid.refresh();
      },
      isOver ? 0 : FILL_SHOWN_MS,
    );
  }

  focusSearch(): void {
    this.words.focus();
    this.words.select();
  }

  /** Models may have been added: asks again for categories and the present search. */
  refresh(): void {
    void this.loadCategories();
    this.search();
  }

  private primitives(): HTMLElement {
    const buttons = PRIMITIVES.map((primitive) => {
      const button = element(
        "button",
        {
          class: "primitive",
          title: t("{{label}}: drag into the scene, or double-click", { label: primitive.label }),
          "aria-label": t("Add {{label}}", { label: primitive.label.toLocaleLowerCase() }),
          "data-testid": `primitive-${primitive.name}`,
          ondblclick: () => void addInFront(this.parts, primitive.entity()),
          onkeydown: (event: KeyboardEvent) => {
            if (event.key === "Enter") void addInFront(this.parts, primitive.entity());
          },
        },
        primitiveDrawing(primitive),
      );
      this.dragIn.from(button, () => ({ entity: primitive.entity(), model: null }));
      return button;
    });
    return element("div", { class: "primitives", role: "group", "aria-label": t("Primitives") }, ...buttons);
  }

  private async loadCategories(): Promise<void> {
    const answer = await this.parts.server.command("catalog.categories", {});
    if (!answer) return;
    const chosen = this.category.value;
    const total = answer.categories.reduce((sum, each) => sum + each.models, 0);
    const option = (value: string, label: string) => element("option", { value }, label);
    this.category.replaceChildren(
      option(ALL, t("All categories ({{total}})", { total: countText(total) })),
      option(RECENT, t("Recently used")),
      option(FAVOURITES, t("Favourites")),
      ...answer.categories.map(({ category, models }) => option(category, `${category ? translateServerText(category) : t("no category")} (${countText(models)})`)),
    );
    this.category.value = [...this.category.options].some(({ value }) => value === chosen) ? chosen : ALL;
  }

  private searchSoon(): void {
    clearTimeout(this.timer);
    this.grid.awaitSearch();
    this.timer = window.setTimeout(() => this.search(), SEARCH_DELAY_MS);
  }

  private search(): void {
    const category = this.category.value;
    const { preferences } = this.parts;
    const words = this.words.value.trim();
    if (category === FAVOURITES) this.showKeys(preferences.get("favourites"), t("your favourites"));
    else if (category === RECENT) this.showKeys(preferences.get("recent"), t("recently used"));
    else {
      const models = words || category ? { ...(words && { words }), ...(category && { category }) } : { all: true as const };
      const text = [words && `“${words}”`, category && t("in {{category}}", { category: translateServerText(category) })].filter(Boolean).join(" ");
      this.parts.found = { models, text: text || t("all models") };
      this.grid.showSearch({ words, category });
    }
  }

  private showKeys(keys: string[], text: string): void {
    this.parts.found = { models: { keys }, text };
    void this.grid.showKeys(keys);
  }

  /** Models of the same category, those of the most similar size first. */
  private async showLike(model: ModelSummary): Promise<void> {
    const answer = await this.parts.server.command("catalog.search", { category: model.category, limit: MOST_ALIKE });
    if (!answer) return;
    const difference = (other: ModelSummary) =>
      Math.hypot(...other.size.map((length, axis) => Math.log(Math.max(length, 1e-3) / Math.max(model.size[axis]!, 1e-3)))) + (other.subcategory === model.subcategory ? 0 : 0.5);
    const keys = answer.models.filter(({ key }) => key !== model.key).sort((a, b) => difference(a) - difference(b)).map(({ key }) => key);
    const text = t("like “{{name}}”", { name: model.name });
    this.parts.found = { models: { keys: [model.key, ...keys] }, text };
    await this.grid.showKeys([model.key, ...keys]);
    setText(this.count, t("{{number}} {{which}}", { number: countText(keys.length), which: text }));
  }

  private showCount(total: number): void {
    setText(this.count, t("{{count, number}} models", { count: total }));
    show(this.empty, total === 0);
    if (total > 0) return;
    const searched = this.words.value.trim() !== "";
    const isFilling = !searched && this.parts.server.fill?.state === "running";
    if (isFilling) {
      this.empty.replaceChildren(element("strong", {}, t("The library is being filled")), element("p", {}, t("Models appear here as they come.")));
      return;
    }
    this.empty.replaceChildren(
      element("strong", {}, searched ? t("No model matches “{{words}}”", { words: this.words.value.trim() }) : t("No models here yet")),
      element("p", {}, searched ? t("Try fewer or shorter words, or another category.") : t("Drop a model file onto the scene to import it, or run “embody import”.")),
    );
    if (searched) this.empty.append(element("button", { class: "text-button", onclick: () => this.forgetSearch() }, t("Show all models")));
  }

  private forgetSearch(): void {
    this.words.value = "";
    this.category.value = ALL;
    this.search();
    this.words.focus();
  }

  private wordsKey(event: KeyboardEvent): void {
    if (event.key === "ArrowDown" || event.key === "Enter") {
      event.preventDefault();
      this.grid.focusFirst();
    } else if (event.key === "Escape") this.forgetSearch();
  }

  private remember(model: ModelSummary): void {
    const recent = this.parts.preferences.get("recent").filter((key) => key !== model.key);
    this.parts.preferences.set("recent", [model.key, ...recent].slice(0, 60));
  }
}

function primitiveDrawing(primitive: Primitive): SVGSVGElement {
  const drawing = document.createElementNS("http://www.w3.org/2000/svg", "svg");
  const path = document.createElementNS("http://www.w3.org/2000/svg", "path");
  drawing.setAttribute("viewBox", "0 0 32 32");
  drawing.setAttribute("aria-hidden", "true");
  path.setAttribute("d", primitive.drawing);
  drawing.append(path);
  return drawing;
}
