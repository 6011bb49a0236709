// SPDX-License-Identifier: MIT
import uPlot from "uplot";
import "uplot/dist/uPlot.min.css";
import type { Curve, Quantity } from "../connection/messages";
import { nameOf } from "../document/scene_document";
import { element, setText, show } from "../panels/element";
import type { Parts } from "../parts";
import { Signal } from "../signal";
import { download } from "./download";
import { t } from "../language";

const QUANTITIES: readonly [Quantity, string][] = [
  ["height", t("Height")],
  ["speed", t("Speed")],
  ["spin", t("Spin")],
  ["kinetic_energy", t("Kinetic energy")],
  ["momentum", t("Momentum")],
  ["x", t("Place along X")],
  ["z", t("Place along Z")],
];
/** Lines that can be told apart, in both themes; and samples of each. */
const COLORS = ["#ff9d2e", "#4ea3ff", "#3fae52", "#e5493d", "#b07cff", "#18b3ac", "#d6629c", "#9a8c4a"];
const SAMPLES = 800;
const HEIGHT_PX = 190;
/** The curves are asked for anew at most this often, ms. */
const REFRESH_MS = 700;

/** Curves of the selected things over the run. */
export class Plots {
  readonly root: HTMLElement;
  /** The user wants to see this time, s. */
  readonly wanted = new Signal<number>();
  private readonly quantity = element("select", { "aria-label": t("What is plotted"), "data-testid": "plot-quantity" }, ...QUANTITIES.map(([name, label]) => element("option", { value: name }, label)));
  private readonly hint = element("p", { class: "note", "data-testid": "plot-hint" });
  private readonly save = element("button", { class: "time-button", "data-testid": "plot-csv", title: t("Save the numbers as a table"), onclick: () => this.export() }, t("Save as CSV"));
  private readonly field = element("div", { class: "plot-field", "data-testid": "plot-field" });
  private plot: uPlot | null = null;
  private shape = "";
  private timer = 0;
  private times: number[] = [];
  private curves: Curve[] = [];

  constructor(private readonly parts: Pick<Parts, "server" | "document" | "playback" | "take" | "selection" | "preferences">) {
    this.root = element("div", { class: "plots", "data-testid": "plots" }, element("div", { class: "plot-row" }, this.quantity, this.hint, element("span", { class: "spacer" }), this.save), this.field);
    this.quantity.addEventListener("change", () => void this.ask());
    new ResizeObserver(() => this.plot?.setSize({ width: this.field.clientWidth, height: HEIGHT_PX })).observe(this.field);
    parts.selection.changed.on(() => this.askSoon());
    parts.take.changed.on(() => this.askSoon());
    parts.preferences.changed.on((name) => {
      if (name === "theme") this.shape = "";
      if (name === "theme" || name === "plots") void this.ask();
    });
    show(this.root, false);
    void this.ask();
  }

  /** What is plotted, for tests. */
  get told(): { times: readonly number[]; curves: readonly Curve[] } {
    return { times: this.times, curves: this.curves };
  }

  /** Draws the line of the moment that is shown. */
  tick(): void {
    if (!this.root.hidden) this.plot?.redraw(false);
  }

  private askSoon(): void {
    if (!this.parts.preferences.get("plots")) return;
    this.timer ||= window.setTimeout(() => void this.ask(), REFRESH_MS);
  }

  private async ask(): Promise<void> {
    clearTimeout(this.timer);
    this.timer = 0;
    const { preferences, take, selection, server } = this.parts;
    show(this.root, preferences.get("plots") && take.isThere);
    if (this.root.hidden || !server.isOpen) return;
    const indices = selection.indices.slice(0, COLORS.length);
    const more = selection.indices.length - indices.length;
    setText(this.hint, indices.length === 0 ? t("Select up to eight things to plot them over the run.") : more > 0 ? t("The first {{shown}} of {{count}} selected things.", { shown: COLORS.length, count: selection.indices.length }) : "");
    const quantity = this.quantity.value as Quantity;
    const told = indices.length > 0 ? await server.command("time.curves", { curves: indices.map((index) => ({ index, quantity })), samples: SAMPLES }) : { times: [], curves: [] };
    if (!told) return;
    this.times = told.times;
    this.curves = told.curves;
    this.save.disabled = told.curves.length === 0;
    show(this.field, told.curves.length > 0);
    if (told.curves.length > 0) this.draw();
  }

  private draw(): void {
    const data: uPlot.AlignedData = [this.times, ...this.curves.map(({ values }) => values)];
    const shape = this.curves.map(({ index, quantity }) => `${index} ${quantity}`).join();
    if (this.plot && shape === this.shape) {
      this.plot.setData(data);
      return;
    }
    this.shape = shape;
    this.plot?.destroy();
    const style = getComputedStyle(this.root);
    const dim = style.getPropertyValue("--dim").trim();
    const line = style.getPropertyValue("--line").trim();
    const unit = this.curves[0]!.unit;
    const axis = (label: string): uPlot.Axis => ({ label, labelSize: 18, size: label.startsWith("Time") ? 32 : 56, font: "11px system-ui, sans-serif", labelFont: "11px system-ui, sans-serif", stroke: dim, grid: { stroke: line, width: 1 }, ticks: { stroke: line, width: 1 } });
    const label = QUANTITIES.find(([name]) => name === this.curves[0]!.quantity)![1];
    this.plot = new uPlot(
      {
        width: this.field.clientWidth,
        height: HEIGHT_PX,
        scales: { x: { time: false } },
        axes: [axis(t("Time (s)")), axis(`${label} (${unit})`)],
        series: [
          { label: t("Time"), value: (_, value) => (value === null ? "–" : `${value.toFixed(3)} s`) },
          ...this.curves.map(({ index }, at) => ({
            label: this.nameOf(index),
            stroke: COLORS[at]!,
            width: 1.5,
            value: (_: uPlot, value: number | null) => (value === null ? "–" : `${value.toPrecision(5)} ${unit}`),
          })),
        ],
        hooks: { draw: [(plot) => this.drawMoment(plot)] },
      },
      data,
      this.field,
    );
    this.plot.over.addEventListener("click", (event) => this.wanted.emit(this.plot!.posToVal(event.offsetX, "x")));
  }

  private drawMoment(plot: uPlot): void {
    const { take, playback } = this.parts;
    const now = take.state.shown ?? playback.simulation.time;
    const at = plot.valToPos(now, "x", true);
    if (at < plot.bbox.left || at > plot.bbox.left + plot.bbox.width) return;
    plot.ctx.save();
    plot.ctx.strokeStyle = getComputedStyle(this.root).getPropertyValue("--accent").trim();
    plot.ctx.lineWidth = devicePixelRatio;
    plot.ctx.beginPath();
    plot.ctx.moveTo(at, plot.bbox.top);
    plot.ctx.lineTo(at, plot.bbox.top + plot.bbox.height);
    plot.ctx.stroke();
    plot.ctx.restore();
  }

  private nameOf(index: number): string {
    const entity = this.parts.document.entity(index);
    return entity ? nameOf(entity) : t("Entity {{index}}", { index });
  }

  /** A table of the curves: a column for the time, and one for each thing. */
  private export(): void {
    const quoted = (text: string) => `"${text.replaceAll('"', '""')}"`;
    const heads = [t("Time (s)"), ...this.curves.map(({ index, quantity, unit }) => `${this.nameOf(index)} ${quantity.replace("_", " ")} (${unit})`)];
    const rows = this.times.map((time, at) => [time, ...this.curves.map(({ values }) => values[at] ?? "")].join(","));
    const name = `${this.parts.document.title || "scene"} ${this.quantity.value}.csv`;
    download(new Blob([[heads.map(quoted).join(","), ...rows, ""].join("\r\n")], { type: "text/csv" }), name);
  }
}
