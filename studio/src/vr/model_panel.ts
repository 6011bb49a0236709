// SPDX-License-Identifier: MIT
import type { ModelSummary } from "../connection/messages";
import { entityOf } from "../document/entity_of_model";
import type { Parts } from "../parts";
import { PRIMITIVES, type Primitive } from "../tools/primitives";
import type { Carry } from "./carry";
import type { Side } from "./hand";
import { Desk } from "./ui/desk";
import { keyboard, speech } from "./ui/keyboard";
import { type Box, SMALL, TEXT } from "./ui/painter";
import { BAR, Panel } from "./ui/panel";
import { button, label, type Widget } from "./ui/widgets";
import { countText, t, translateServerText } from "../language";

/** mm */
const WIDTH = 470;
const HEIGHT = 440;
const LIST = 124;
const TILE = 80;
const COLUMNS = 4;
const ROWS = 3;
const PAGE = COLUMNS * ROWS;
/** Below the keyboard one row of tiles is seen. */
const KEYS_END = BAR + 262;
const NAMES_SHOWN = 9;
const NAME_HEIGHT = 30;
const SEARCH_DELAY_MS = 250;
const MOST_REMEMBERED = 60;
const MOST_PICTURES = 240;

const ALL = t("All");
const SHAPES = t("Shapes");
const FAVOURITES = t("Favourites");
const RECENT = t("Recent");
const OWN = [ALL, SHAPES, RECENT, FAVOURITES];

/** The catalogue as a panel in the room: categories, search, pictures; a tile is pulled out with the trigger. */
export class ModelPanel {
  readonly panel = new Panel({ id: "models", title: t("Models"), width: WIDTH, height: HEIGHT, hasBar: true });
  private categories: { category: string; models: number }[] = [];
  private category = ALL;
  private words = "";
  private types = false;
  private hears = false;
  private first = 0;
  private firstName = 0;
  private total = 0;
  private models: ModelSummary[] = [];
  private generation = 0;
  private timer = 0;
  private readonly pictures = new Map<string, HTMLImageElement>();
  private readonly speech = speech();

  constructor(
    private readonly parts: Pick<Parts, "preferences" | "server" | "models">,
    private readonly desk: Desk,
    private readonly carry: Carry,
  ) {
    desk.add(this.panel);
    this.panel.scroll = (rows) => this.page(rows);
    carry.added.on(({ model }) => {
      if (!model) return;
      const recent = parts.preferences.get("recent").filter((key) => key !== model.key);
      parts.preferences.set("recent", [model.key, ...recent].slice(0, MOST_REMEMBERED));
    });
    parts.server.catalogChanged.on(() => this.panel.isShown && void this.search());
  }

  open(): void {
    this.desk.open(this.panel, -0.27);
    void this.begin();
  }

  toggle(): void {
    if (this.panel.isShown) this.panel.show(false);
    else this.open();
  }

  private async begin(): Promise<void> {
    this.layOut();
    const answer = await this.parts.server.command("catalog.categories", {});
    this.categories = answer?.categories.filter(({ category }) => category !== "") ?? [];
    await this.search();
  }

  private choose(category: string): void {
    this.category = category;
    this.first = 0;
    void this.search();
  }

  private setWords(words: string): void {
    this.words = words;
    this.first = 0;
    if (OWN.includes(this.category)) this.category = ALL;
    this.layOut();
    clearTimeout(this.timer);
    this.timer = window.setTimeout(() => void this.search(), SEARCH_DELAY_MS);
  }

  private page(rows: number): void {
    const last = Math.max(0, Math.ceil((this.total - PAGE) / COLUMNS) * COLUMNS);
    const first = Math.min(Math.max(this.first + rows * COLUMNS, 0), last);
    if (first === this.first) return;
    this.first = first;
    void this.search();
  }

  /** Loads the models that are in sight. */
  private async search(): Promise<void> {
    const generation = ++this.generation;
    const { category, words } = this;
    if (category === SHAPES) {
      this.total = PRIMITIVES.length;
      this.layOut();
      return;
    }
    const found = category === FAVOURITES || category === RECENT ? await this.kept(category) : await this.find(words.trim(), category === ALL ? "" : category);
    if (generation !== this.generation || !found) return;
    this.models = found.models;
    this.total = found.total;
    for (const model of found.models) this.parts.models.learn(model);
    this.layOut();
  }

  private find(words: string, category: string): Promise<{ models: ModelSummary[]; total: number } | undefined> {
    return this.parts.server.command("catalog.search", { ...(words && { words }), ...(category && { category }), limit: PAGE, offset: this.first });
  }

  private async kept(category: string): Promise<{ models: ModelSummary[]; total: number }> {
    const keys = this.parts.preferences.get(category === RECENT ? "recent" : "favourites");
    const answers = await Promise.allSettled(keys.slice(this.first, this.first + PAGE).map((key) => this.parts.models.summary(key)));
    return { models: answers.flatMap((answer) => (answer.status === "fulfilled" ? [answer.value] : [])), total: keys.length };
  }

  private layOut(): void {
    const shown = this.category === SHAPES ? PRIMITIVES.slice(this.first, this.first + PAGE).map((shape, at) => this.shapeTile(shape, at)) : this.models.map((model, at) => this.modelTile(model, at));
    this.panel.widgets = [
      Desk.closer(this.panel),
      ...this.searchRow(),
      ...this.names(),
      ...(this.types ? [...this.keys(), ...shown.slice(0, COLUMNS)] : shown),
      ...this.pager(),
      ...(shown.length === 0 && !this.types ? this.nothing() : []),
    ];
    this.panel.renew();
  }

  private searchRow(): Widget[] {
    const box = { x: LIST + 16, y: BAR + 8, w: WIDTH - LIST - 28, h: 34 };
    return [
      {
        id: "search",
        box,
        paint: (painter, { hover }) => {
          painter.fill(box, 6, "ground");
          painter.outline(box, 6, this.types || hover ? "accent" : "line", 1);
          painter.icon("search", box.x + 17, box.y + box.h / 2, 15, "dim");
          painter.text(this.words || t("Search models"), box.x + 34, box.y + box.h / 2, { size: TEXT, color: this.words ? "text" : "dim", width: box.w - 44 });
        },
        release: (_x, _y, inside) => {
          if (!inside) return;
          this.types = !this.types;
          this.layOut();
        },
      },
    ];
  }

  /** The categories on the left, a page at a time. */
  private names(): Widget[] {
    const all = [...OWN, ...this.categories.map(({ category }) => category)];
    const page = (by: number): void => {
      this.firstName = Math.min(Math.max(this.firstName + by * (NAMES_SHOWN - 1), 0), Math.max(all.length - NAMES_SHOWN, 0));
      this.layOut();
    };
    const at = (line: number): Box => ({ x: 10, y: BAR + 8 + line * (NAME_HEIGHT + 4), w: LIST - 4, h: NAME_HEIGHT });
    const names = all.slice(this.firstName, this.firstName + NAMES_SHOWN).map((name, line) => {
      const models = this.categories.find(({ category }) => category === name)?.models;
      const box = at(line + 1);
      return button({ id: `category-${name}`, box, label: models ? `${translateServerText(name)} ${models}` : translateServerText(name), on: this.category === name, run: () => this.choose(name) });
    });
    return [
      button({ id: "names-up", box: at(0), icon: "up", off: this.firstName === 0, run: () => page(-1) }),
      ...names,
      button({ id: "names-down", box: at(NAMES_SHOWN + 1), icon: "down", off: this.firstName + NAMES_SHOWN >= all.length, run: () => page(1) }),
    ];
  }

  private keys(): Widget[] {
    const listen = this.speech && (() => this.listen());
    const close = (): void => {
      this.types = false;
      this.layOut();
    };
    return keyboard({
      box: { x: LIST + 16, y: BAR + 52, w: WIDTH - LIST - 28, h: KEYS_END - BAR - 60 },
      type: (text) => this.setWords(this.words + text),
      erase: () => this.setWords(this.words.slice(0, -1)),
      done: close,
      listen,
      hears: this.hears,
    });
  }

  private listen(): void {
    this.hears = true;
    this.layOut();
    this.speech!((heard) => this.setWords(heard.toLowerCase()), () => {
      this.hears = false;
      this.layOut();
    });
  }

  private pager(): Widget[] {
    const y = HEIGHT - 40;
    const last = Math.min(this.first + PAGE, this.total);
    const text = this.total === 0 ? "" : t("{{first}} – {{last}} of {{total}}", { first: this.first + 1, last, total: countText(this.total) });
    return [
      button({ id: "page-up", box: { x: LIST + 16, y, w: 60, h: 30 }, icon: "up", off: this.first === 0, run: () => this.page(-ROWS) }),
      label("count", { x: LIST + 84, y, w: WIDTH - LIST - 164, h: 30 }, text, { size: SMALL, color: "dim", align: "center" }),
      button({ id: "page-down", box: { x: WIDTH - 72, y, w: 60, h: 30 }, icon: "down", off: last >= this.total, run: () => this.page(ROWS) }),
    ];
  }

  private nothing(): Widget[] {
    const text = this.words ? t("No model matches “{{words}}”. Try fewer or shorter words, or another category.", { words: this.words }) : this.category === RECENT ? t("What you add appears here.") : this.category === FAVOURITES ? t("Mark models with the star in the page's browser.") : t("No models yet: run “embody import”.");
    return [label("empty", { x: LIST + 24, y: BAR + 70, w: WIDTH - LIST - 44, h: 80 }, text, { size: TEXT, color: "dim", rows: 4 })];
  }

  private tileBox(at: number): Box {
    const width = (WIDTH - LIST - 28 - (COLUMNS - 1) * 5) / COLUMNS;
    return { x: LIST + 16 + (at % COLUMNS) * (width + 5), y: (this.types ? KEYS_END : BAR + 52) + Math.floor(at / COLUMNS) * (TILE + 24), w: width, h: TILE + 19 };
  }

  /** Pressed and pulled off the panel, or clicked: it is in the hand. */
  private tile(id: string, at: number, name: string, paint: Widget["paint"], take: (side: Side, sticky: boolean) => void): Widget {
    const box = this.tileBox(at);
    return {
      id,
      box,
      paint: (painter, look) => {
        painter.fill(box, 8, look.pressed ? "line" : look.hover ? "hover" : "raised");
        if (look.hover) painter.outline(box, 8, "accent", 1);
        paint(painter, look);
        painter.text(name, box.x + box.w / 2, box.y + box.h - 10, { size: SMALL, align: "center", width: box.w - 6 });
      },
      leave: (side) => take(side, false),
      release: (_x, _y, inside, side) => {
        if (inside) take(side, true);
      },
    };
  }

  private modelTile(model: ModelSummary, at: number): Widget {
    const { x, y, w } = this.tileBox(at);
    const picture = { x: x + 4, y: y + 3, w: w - 8, h: TILE - 6 };
    const paint: Widget["paint"] = (painter) => {
      const image = this.picture(model);
      if (image.complete && image.naturalWidth > 0) painter.picture(image, picture);
    };
    return this.tile(`tile-${model.key}`, at, model.name, paint, (side, sticky) => this.carry.take(side, entityOf(model), model, sticky));
  }

  private shapeTile(shape: Primitive, at: number): Widget {
    const { x, y, w } = this.tileBox(at);
    const drawing = new Path2D(shape.drawing);
    const paint: Widget["paint"] = ({ context, color }) => {
      context.translate(x + w / 2 - 28, y + 10);
      context.scale(1.75, 1.75);
      context.lineWidth = 1.2;
      context.lineJoin = context.lineCap = "round";
      context.strokeStyle = color.call(this.panel.painter, "accent");
      context.stroke(drawing);
      context.setTransform(2, 0, 0, 2, 0, 0);
    };
    return this.tile(`shape-${shape.name}`, at, shape.label, paint, (side, sticky) => this.carry.take(side, shape.entity(), null, sticky));
  }

  private picture(model: ModelSummary): HTMLImageElement {
    const address = this.parts.models.thumbnail(model);
    let image = this.pictures.get(address);
    if (!image) {
      image = new Image();
      image.onload = () => this.panel.renew();
      image.src = address;
      if (this.pictures.size > MOST_PICTURES) this.pictures.clear();
      this.pictures.set(address, image);
    }
    return image;
  }
}
