// SPDX-License-Identifier: MIT
import type { ModelSummary } from "../connection/messages";
import { entityOf } from "../document/entity_of_model";
import { Signal } from "../signal";
import type { Parts } from "../parts";
import { addInFront } from "../tools/ghost";
import type { DragIn } from "./drag_in";
import { openMenu } from "./context_menu";
import { element } from "./element";
import { icon } from "../tools/icons";
import { t, translateServerText } from "../language";

const PAGE = 60;
const TILE_WIDTH = 92;
const TILE_HEIGHT = 118;
/** Rows that are made in advance above and below the visible ones. */
const SPARE_ROWS = 2;

interface Search {
  words: string;
  category: string;
}

/** Thumbnails of any number of models: only the visible tiles exist, and only the visible pages are asked for. */
export class ModelGrid {
  readonly root: HTMLElement;
  readonly counted = new Signal<number>();
  readonly used = new Signal<ModelSummary>();
  /** The user asked for models of the same category and a similar size. */
  readonly likeWanted = new Signal<ModelSummary>();
  private readonly canvas = element("div", { class: "tiles" });
  private search: Search = { words: "", category: "" };
  private pages = new Map<number, ModelSummary[] | "asked">();
  private readonly tiles = new Map<number, HTMLElement>();
  private total = 0;
  private active = 0;
  private generation = 0;
  /** Models have come, and are shown when the pointer leaves. */
  private refreshWaits = false;
  /** Shown instead of a search. */
  private keys: readonly string[] | null = null;

  constructor(
    private readonly parts: Pick<Parts, "preferences" | "server" | "selection" | "picked" | "models" | "view">,
    private readonly dragIn: DragIn,
  ) {
    this.root = element(
      "div",
      {
        class: "tile-scroll",
        role: "listbox",
        "aria-label": t("Models"),
        tabindex: 0,
        "data-testid": "model-grid",
        onscroll: () => this.lay(),
        onpointerleave: () => {
          if (this.refreshWaits) void this.refresh();
        },
        onkeydown: (event: KeyboardEvent) => this.key(event),
        onfocus: () => this.lay(),
      },
      this.canvas,
    );
    new ResizeObserver(() => this.lay()).observe(this.root);
    parts.picked.changed.on(() => this.markPicked());
  }

  /** A search will follow: the tiles are those of the last one. */
  awaitSearch(): void {
    this.setBusy(true);
  }

  showSearch(search: Search): void {
    this.search = search;
    this.keys = null;
    this.restart();
    void this.loadPage(0);
  }

  /** Shows exactly these models; models that are no longer in the database are left out. */
  async showKeys(keys: readonly string[]): Promise<void> {
    this.keys = keys;
    this.restart();
    const generation = this.generation;
    const answers = await Promise.allSettled(keys.map((key) => this.parts.models.summary(key)));
    if (generation !== this.generation) return;
    const models = answers.flatMap((answer) => (answer.status === "fulfilled" ? [answer.value] : []));
    for (let page = 0; page * PAGE < models.length; ++page) this.pages.set(page, models.slice(page * PAGE, (page + 1) * PAGE));
    this.setTotal(models.length);
  }

  /** Loads the visible tiles again; the scroll position stays. */
  renew(): void {
    if (this.keys) return void this.showKeys(this.keys);
    ++this.generation;
    this.pages = new Map();
    void this.loadPage(Math.floor(this.active / PAGE));
    this.lay();
  }

  /** Models have come: shows them where the visible tiles are; the scroll position stays, and tiles of the same model stay as they are. */
  async refresh(): Promise<void> {
    // What a person is about to press must not move away; an empty grid has nothing to press.
    if (this.total > 0 && this.root.matches(":hover")) {
      this.refreshWaits = true;
      return;
    }
    this.refreshWaits = false;
    if (this.keys) return;
    const generation = this.generation;
    const { words, category } = this.search;
    const { first, last } = this.visible();
    const firstPage = Math.floor(first / PAGE);
    const lastPage = Math.floor(Math.max(last - 1, first) / PAGE);
    const pages = new Map<number, ModelSummary[]>();
    let total = this.total;
    for (let page = firstPage; page <= lastPage; ++page) {
      const answer = await this.parts.server.command("catalog.search", { limit: PAGE, offset: page * PAGE, ...(words && { words }), ...(category && { category }) });
      if (!answer || generation !== this.generation) return;
      for (const model of answer.models) this.parts.models.learn(model);
      pages.set(page, answer.models);
      total = answer.total;
    }
    ++this.generation;
    this.pages = pages;
    this.total = total;
    for (const [at, tile] of this.tiles) {
      tile.setAttribute("aria-setsize", String(total));
      if (tile.dataset["key"] === this.modelAt(at)?.key) continue;
      tile.remove();
      this.tiles.delete(at);
    }
    this.lay();
    this.counted.emit(total);
  }

  focusFirst(): void {
    if (this.total === 0) return;
    this.root.focus();
    this.activate(0);
  }

  private restart(): void {
    ++this.generation;
    this.pages = new Map();
    this.active = 0;
    this.root.scrollTop = 0;
    this.setBusy(true);
  }

  private async loadPage(page: number): Promise<void> {
    if (this.pages.has(page)) return;
    this.pages.set(page, "asked");
    const generation = this.generation;
    const { words, category } = this.search;
    const answer = await this.parts.server.command("catalog.search", {
      limit: PAGE,
      offset: page * PAGE,
      ...(words && { words }),
      ...(category && { category }),
    });
    if (generation !== this.generation) return;
    if (!answer) {
      this.pages.delete(page);
      this.setBusy(false);
      return;
    }
    for (const model of answer.models) this.parts.models.learn(model);
    this.pages.set(page, answer.models);
    this.setTotal(answer.total);
  }

  private setTotal(total: number): void {
    this.total = total;
    this.clear();
    this.lay();
    this.setBusy(false);
    this.counted.emit(total);
  }

  /** For screen readers and tests: whether other tiles will come. */
  private setBusy(busy: boolean): void {
    this.root.setAttribute("aria-busy", String(busy));
  }

  private clear(): void {
    for (const tile of this.tiles.values()) tile.remove();
    this.tiles.clear();
  }

  private get columns(): number {
    return Math.max(1, Math.floor(this.root.clientWidth / TILE_WIDTH));
  }

  /** The tiles that are in sight, and some above and below: from `first` to before `last`. */
  private visible(): { first: number; last: number } {
    const top = Math.floor(this.root.scrollTop / TILE_HEIGHT) - SPARE_ROWS;
    const bottom = Math.ceil((this.root.scrollTop + this.root.clientHeight) / TILE_HEIGHT) + SPARE_ROWS;
    return { first: Math.max(0, top * this.columns), last: Math.min(this.total, bottom * this.columns) };
  }

  /** Makes the visible tiles and removes the others. */
  private lay(): void {
    const columns = this.columns;
    this.canvas.style.height = `${Math.ceil(this.total / columns) * TILE_HEIGHT}px`;
    const { first, last } = this.visible();
    for (const [at, tile] of this.tiles) {
      if (at >= first && at < last) continue;
      tile.remove();
      this.tiles.delete(at);
    }
    const width = this.root.clientWidth / columns;
    for (let at = first; at < last; ++at) {
      const tile = this.tiles.get(at) ?? this.makeTile(at);
      if (!tile) continue;
      tile.style.width = `${width - 6}px`;
      tile.style.transform = `translate(${(at % columns) * width}px, ${Math.floor(at / columns) * TILE_HEIGHT}px)`;
    }
  }

  private makeTile(at: number): HTMLElement | null {
    const model = this.modelAt(at);
    if (!model) {
      void this.loadPage(Math.floor(at / PAGE));
      return null;
    }
    const tile = element(
      "div",
      {
        class: "tile",
        role: "option",
        id: `tile-${at}`,
        "aria-label": model.name,
        "aria-selected": at === this.active ? "true" : "false",
        "aria-setsize": this.total,
        "aria-posinset": at + 1,
        title: describe(model),
        "data-testid": "model-tile",
        "data-key": model.key,
        onclick: () => this.activate(at),
        ondblclick: () => this.add(model),
        oncontextmenu: (event: MouseEvent) => this.openMenu(event, model),
      },
      element("img", { src: this.parts.models.thumbnail(model), alt: "", loading: "lazy", draggable: "false" }),
      element("span", { class: "tile-name" }, model.name),
      this.star(model),
    );
    this.markFavourite(tile, model);
    this.dragIn.from(tile, () => ({ entity: entityOf(model), model }));
    tile.toggleAttribute("data-picked", this.parts.picked.model?.key === model.key);
    this.tiles.set(at, tile);
    this.canvas.append(tile);
    return tile;
  }

  private openMenu(event: MouseEvent, model: ModelSummary): void {
    event.preventDefault();
    const is = this.parts.preferences.get("favourites").includes(model.key);
    openMenu(
      [
        [
          { label: t("Add to the scene"), run: () => this.add(model) },
          { label: t("Others like this"), id: "like", run: () => this.likeWanted.emit(model) },
        ],
        [
          {
            label: is ? t("No favourite any more") : t("Favourite"),
            run: () => this.toggleFavourite(model),
          },
        ],
      ],
      { x: event.clientX, y: event.clientY },
    );
  }

  private toggleFavourite(model: ModelSummary): void {
    const { preferences } = this.parts;
    const favourites = preferences.get("favourites");
    const is = favourites.includes(model.key);
    preferences.set("favourites", is ? favourites.filter((key) => key !== model.key) : [model.key, ...favourites]);
    for (const tile of this.tiles.values()) if (tile.dataset["key"] === model.key) this.markFavourite(tile, model);
  }

  private markFavourite(tile: HTMLElement, model: ModelSummary): void {
    const is = this.parts.preferences.get("favourites").includes(model.key);
    tile.toggleAttribute("data-favourite", is);
    tile.setAttribute("aria-description", is ? t("a favourite") : "");
  }

  /** A star for the mouse; the keyboard has the key F, everybody the menu. A button may not be inside an option. */
  private star(model: ModelSummary): HTMLElement {
    const click = (event: Event): void => {
      event.stopPropagation();
      this.toggleFavourite(model);
    };
    return element("span", { class: "favourite", "aria-hidden": "true", title: t("Favourite"), onclick: click }, icon("star"));
  }

  private modelAt(at: number): ModelSummary | undefined {
    const page = this.pages.get(Math.floor(at / PAGE));
    return page === "asked" ? undefined : page?.[at % PAGE];
  }

  private markPicked(): void {
    const key = this.parts.picked.model?.key;
    for (const tile of this.tiles.values()) tile.toggleAttribute("data-picked", tile.dataset["key"] === key);
  }

  private add(model: ModelSummary): void {
    this.used.emit(model);
    void addInFront(this.parts, entityOf(model));
  }

  private key(event: KeyboardEvent): void {
    const move: Record<string, number> = { ArrowLeft: -1, ArrowRight: 1, ArrowUp: -this.columns, ArrowDown: this.columns };
    const by = move[event.key];
    if (by !== undefined) {
      this.activate(Math.min(Math.max(this.active + by, 0), this.total - 1));
    } else if (event.key === "Enter") {
      const model = this.modelAt(this.active);
      if (model) this.add(model);
    } else if (event.key === "f") {
      const model = this.modelAt(this.active);
      if (model) this.toggleFavourite(model);
    } else return;
    event.preventDefault();
  }

  /** Makes one tile the active one, which Enter adds, scrolls it into view, and shows the model's attributes. */
  private activate(at: number): void {
    this.tiles.get(this.active)?.setAttribute("aria-selected", "false");
    this.active = at;
    const top = Math.floor(at / this.columns) * TILE_HEIGHT;
    if (top < this.root.scrollTop) this.root.scrollTop = top;
    else if (top + TILE_HEIGHT > this.root.scrollTop + this.root.clientHeight) this.root.scrollTop = top + TILE_HEIGHT - this.root.clientHeight;
    this.lay();
    this.tiles.get(at)?.setAttribute("aria-selected", "true");
    this.root.setAttribute("aria-activedescendant", `tile-${at}`);
    const model = this.modelAt(at);
    if (model) this.parts.picked.set(model);
  }
}

function describe(model: ModelSummary): string {
  const size = model.size.map((length) => length.toPrecision(3)).join(" × ");
  const lines = [model.name, [model.category, model.subcategory].filter(Boolean).map(translateServerText).join(" / "), `${size} m`];
  lines.push(t("{{count, number}} triangles", { count: model.triangles }));
  if (model.author) lines.push(t("by {{author}}", { author: model.author }));
  if (model.licence) lines.push(model.licence);
  return lines.join("\n");
}
