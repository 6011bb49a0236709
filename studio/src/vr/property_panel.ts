// SPDX-License-Identifier: MIT
import { Vector3 } from "three";
import { CommandRefused, reasonText } from "../connection/connection";
import type { AttributeEntry } from "../connection/messages";
import { nameOf } from "../document/scene_document";
import type { Parts } from "../parts";
import type { UserAction } from "../tools/actions";
import type { IconName } from "../tools/icons";
import { isLocked } from "./near";
import { Desk } from "./ui/desk";
import { SMALL, TEXT } from "./ui/painter";
import { BAR, Panel } from "./ui/panel";
import { button, label, slider, type Widget } from "./ui/widgets";
import { t, translateServerText } from "../language";

/** mm */
const WIDTH = 400;
const ROW = 64;
const ROWS = 5;
const HEAD = BAR + 76;
const HEIGHT = HEAD + ROWS * ROW + 40;
const REFRESH_DELAY_MS = 80;
/** A range that reaches over more than this factor is shown by its logarithm. */
const WIDE = 50;
/** Where an attribute has no range, the slider reaches by this factor up and down from the value. */
const REACH = 100;
/** What people look for first. */
const FIRST = ["mass", "friction_static", "friction_dynamic", "restitution", "density", "youngs_modulus", "stretch_stiffness", "bend_stiffness", "viscosity", "surface_tension"];

/** What the selected thing is made of, with sliders; and what can be done with it. */
export class PropertyPanel {
  readonly panel = new Panel({ id: "properties", title: t("Properties"), width: WIDTH, height: HEIGHT, hasBar: true });
  private entries: AttributeEntry[] = [];
  private first = 0;
  private timer = 0;
  private generation = 0;
  private static edits = 0;
  private sending = false;
  private newest: { name: string; value: number; merge: string } | null = null;
  private merge = "";
  /** Why the last edit was refused, by attribute. */
  private readonly refused = new Map<string, string>();

  constructor(
    private readonly parts: Pick<Parts, "server" | "notices" | "document" | "playback" | "selection" | "entities" | "preferences">,
    private readonly desk: Desk,
    private readonly actions: readonly UserAction[],
  ) {
    desk.add(this.panel);
    this.panel.scroll = (rows) => this.page(rows);
    parts.selection.changed.on(() => {
      this.first = 0;
      this.refused.clear();
      this.refreshSoon();
    });
    parts.document.changed.on(({ all, entities }) => {
      if (all || entities.some((index) => parts.selection.has(index))) this.refreshSoon();
    });
    parts.preferences.changed.on((name) => name === "snap" && this.layOut());
  }

  open(): void {
    this.desk.open(this.panel, 0.27);
    void this.refresh();
  }

  toggle(): void {
    if (this.panel.isShown) this.panel.show(false);
    else this.open();
  }

  private refreshSoon(): void {
    clearTimeout(this.timer);
    if (this.panel.isShown) this.timer = window.setTimeout(() => void this.refresh(), REFRESH_DELAY_MS);
  }

  private get index(): number | undefined {
    return this.parts.selection.indices.at(-1);
  }

  private async refresh(): Promise<void> {
    const generation = ++this.generation;
    const { index } = this;
    const answer = index === undefined ? undefined : await this.parts.server.command("entity.attributes", { index });
    if (generation !== this.generation) return;
    const numbers = answer?.attributes.filter(({ type, value, name }) => type === "number" && typeof value === "number" && !name.startsWith("collision_")) ?? [];
    const rank = ({ name }: AttributeEntry): number => (FIRST.includes(name) ? FIRST.indexOf(name) : FIRST.length);
    this.entries = numbers.sort((a, b) => rank(a) - rank(b));
    this.layOut();
  }

  private page(rows: number): void {
    this.first = Math.min(Math.max(this.first + rows, 0), Math.max(this.entries.length - ROWS, 0));
    this.layOut();
  }

  private layOut(): void {
    const entity = this.index === undefined ? undefined : this.parts.document.entity(this.index);
    this.panel.options.title = entity ? nameOf(entity) : t("Nothing selected");
    this.panel.widgets = [Desk.closer(this.panel), ...(entity ? [...this.headOf(isLocked(entity)), ...this.rows(), ...this.pager()] : [label("none", { x: 16, y: HEAD, w: WIDTH - 32, h: 80 }, t("Grab a thing, or point at it and pull the trigger."), { color: "dim", rows: 3 })])];
    this.panel.renew();
  }

  private headOf(locked: boolean): Widget[] {
    const size = this.parts.entities.boundsOf([this.index!], performance.now()).getSize(new Vector3());
    const text = [size.x, size.y, size.z].map((length) => length.toFixed(2)).join(" × ");
    const width = (WIDTH - 24 - 4 * 5) / 6;
    const tools: [string, IconName, string, boolean, () => void][] = [
      ["duplicate", "copy", t("Copy"), false, () => this.act("edit.duplicate")],
      ["delete", "bin", t("Delete"), false, () => this.act("edit.delete")],
      ["drop", "drop", t("Drop"), false, () => this.act("edit.drop")],
      ["lock", locked ? "lock" : "unlock", locked ? t("Locked") : t("Lock"), locked, () => void this.parts.server.command("entity.lock", { indices: [...this.parts.selection.indices], locked: !locked })],
      ["snap", "snap", t("Snap"), this.parts.preferences.get("snap"), () => this.act("tool.snap")],
      ["undo", "undo", t("Undo"), false, () => this.act("edit.undo")],
    ];
    return [
      label("size", { x: 14, y: BAR + 4, w: WIDTH - 28, h: 18 }, t("{{size}} m (width × height × depth)", { size: text }), { size: SMALL, color: "dim" }),
      ...tools.map(([id, icon, name, on, run], at) => button({ id, icon, label: name, on, run, box: { x: 12 + at * (width + 4), y: BAR + 26, w: width, h: 42 } })),
    ];
  }

  private act(id: string): void {
    this.actions.find((action) => action.id === id)?.run();
  }

  private rows(): Widget[] {
    return this.entries.slice(this.first, this.first + ROWS).flatMap((entry, line) => this.row(entry, HEAD + 4 + line * ROW));
  }

  private row(entry: AttributeEntry, y: number): Widget[] {
    const { name, overridden, unit } = entry;
    const value = entry.value as number;
    const [low, high] = rangeOf(entry);
    const scale = scaleOf(low, high);
    const likely = entry.low === null || entry.high === null || entry.low === undefined ? null : ([scale.part(entry.low), scale.part(entry.high!)] as [number, number]);
    const interval = likely ? `80 %: ${short(entry.low!)} … ${short(entry.high!)}` : "";
    const why = this.refused.get(name);
    const source = why ?? [interval, overridden ? t("set by hand") : translateServerText(entry.source)].filter(Boolean).join("  ·  ");
    return [
      label(`name-${name}`, { x: 14, y, w: 200, h: 20 }, translateServerText(entry.label) || name, { size: TEXT - 1 }),
      label(`value-${name}`, { x: 214, y, w: WIDTH - 228 - 34, h: 20 }, `${short(value)}${unit && unit !== "1" ? ` ${unit}` : ""}`, { size: TEXT - 1, bold: true, align: "right", color: overridden ? "accent" : "text" }),
      slider({ id: `slider-${name}`, box: { x: 10, y: y + 18, w: WIDTH - 58, h: 26 }, part: scale.part(value), likely, change: (part) => this.change(entry, scale.value(part)), end: () => (this.merge = "") }),
      button({ id: `reset-${name}`, box: { x: WIDTH - 42, y: y + 4, w: 30, h: 36 }, icon: "undo", off: !overridden, run: () => void this.reset(name) }),
      label(`source-${name}`, { x: 14, y: y + 43, w: WIDTH - 28, h: 16 }, source, { size: SMALL, color: why ? "error" : "dim" }),
    ];
  }

  private pager(): Widget[] {
    const y = HEIGHT - 36;
    const last = Math.min(this.first + ROWS, this.entries.length);
    return [
      button({ id: "rows-up", box: { x: 12, y, w: 70, h: 28 }, icon: "up", off: this.first === 0, run: () => this.page(-ROWS) }),
      label("rows", { x: 90, y, w: WIDTH - 180, h: 28 }, t("{{first}} – {{last}} of {{total}}", { first: this.first + 1, last, total: this.entries.length }), { size: SMALL, color: "dim", align: "center" }),
      button({ id: "rows-down", box: { x: WIDTH - 82, y, w: 70, h: 28 }, icon: "down", off: last >= this.entries.length, run: () => this.page(ROWS) }),
    ];
  }

  /** A slider moved: the value is sent as fast as the server answers, all in one step of undo. */
  private change(entry: AttributeEntry, value: number): void {
    this.merge ||= `vr-attribute-${Date.now()}-${PropertyPanel.edits++}`;
    this.newest = { name: entry.name, value, merge: this.merge };
    entry.value = value;
    this.layOut();
    if (!this.sending) void this.send();
  }

  private async send(): Promise<void> {
    this.sending = true;
    while (this.newest) {
      const { name, value, merge } = this.newest;
      this.newest = null;
      await this.edit(name, this.parts.server.request("entity.set_attribute", { indices: [...this.parts.selection.indices], name, value, merge }));
    }
    this.sending = false;
    this.refreshSoon();
  }

  private async reset(name: string): Promise<void> {
    await this.edit(name, this.parts.server.request("entity.reset_attribute", { indices: [...this.parts.selection.indices], name }));
    this.refreshSoon();
  }

  /** Waits for an edit; a refusal is shown in the attribute's row. */
  private async edit(name: string, done: Promise<unknown>): Promise<void> {
    try {
      await done;
      this.refused.delete(name);
    } catch (error) {
      if (!(error instanceof CommandRefused)) this.parts.notices.report(error as Error);
      this.refused.set(name, reasonText(error as Error));
    }
  }
}

/** The range that a slider covers. */
function rangeOf({ range, value, low, high }: AttributeEntry): [number, number] {
  const now = value as number;
  const least = range?.[0] ?? (now > 0 ? now / REACH : -REACH);
  const most = range?.[1] ?? (now > 0 ? now * REACH : REACH);
  // A range over many decades is cut to what is likely: the slider would be too coarse.
  if (least > 0 && now > 0 && most / least > REACH * REACH) {
    return [Math.max(least, Math.min(now, low ?? now) / REACH), Math.min(most, Math.max(now, high ?? now) * REACH)];
  }
  return [least, most];
}

function scaleOf(low: number, high: number): { part(value: number): number; value(part: number): number } {
  const clamp = (part: number): number => Math.min(Math.max(part, 0), 1);
  if (low > 0 && high / low > WIDE)
    return {
      part: (value) => clamp(Math.log(Math.max(value, low) / low) / Math.log(high / low)),
      value: (part) => Number((low * (high / low) ** part).toPrecision(3)),
    };
  return { part: (value) => clamp((value - low) / (high - low)), value: (part) => Number((low + part * (high - low)).toPrecision(3)) };
}

function short(value: number): string {
  const size = Math.abs(value);
  if (size !== 0 && (size < 1e-3 || size >= 1e6)) return value.toExponential(1).replace("e+", "e");
  return String(Number(value.toPrecision(3)));
}
