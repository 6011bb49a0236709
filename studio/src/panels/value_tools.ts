// SPDX-License-Identifier: MIT
import type { AttributeEntry, MaterialPreset } from "../connection/messages";
import { nameOf } from "../document/scene_document";
import type { Parts } from "../parts";
import { valueText, unitText } from "./attribute_row";
import { dialogButtons, openDialog } from "./dialogs";
import { element, show } from "./element";
import { numberText } from "./number_text";
import { t, translateServerText } from "../language";

/** Values that are offered to copy although nobody set them. */
const USUALLY_COPIED = ["surface_material", "mass", "density", "friction_static", "friction_dynamic", "restitution"];
/** So many presets are buttons; the others are in the list behind them. */
const FIRST_PRESETS = 6;

type ToolParts = Pick<Parts, "server" | "notices" | "document" | "selection">;

/** Materials by one click, and values copied from one thing to others. */
export class ValueTools {
  readonly root: HTMLElement;
  private readonly materials = element("div", { class: "preset-chips", role: "group", "aria-label": t("Make it of"), "data-testid": "presets" });
  private readonly copy = element("button", { class: "chip", title: t("Remember the values of this thing, to give them to others"), "data-testid": "copy-values", onclick: () => this.remember() }, t("Copy values"));
  private readonly paste = element("button", { class: "chip", "data-testid": "paste-values", onclick: () => void openPaste(this.parts, this.source) });
  private source = 0;

  constructor(private readonly parts: ToolParts) {
    this.root = element("div", { class: "value-tools", "data-testid": "value-tools" }, this.materials, element("div", { class: "preset-chips" }, this.copy, this.paste));
    parts.selection.changed.on(() => this.update());
    parts.document.changed.on(() => this.update());
    parts.server.changed.on(() => parts.server.ready && this.materials.childElementCount === 0 && void this.load());
    this.update();
  }

  /** Without a database there are no materials. */
  private async load(): Promise<void> {
    const told = await this.parts.server.request("entity.presets", {}).catch(() => null);
    if (!told || this.materials.childElementCount > 0) return;
    const { presets } = told;
    const more = element(
      "select",
      { class: "chip", "aria-label": t("Other materials"), "data-testid": "more-presets", onchange: () => (more.value && this.apply(more.value), (more.value = "")) },
      element("option", { value: "" }, t("Other…")),
      ...presets.slice(FIRST_PRESETS).map(({ preset, label }) => element("option", { value: preset }, translateServerText(label))),
    );
    this.materials.replaceChildren(
      element("span", { class: "note" }, t("Make it of:")),
      ...presets.slice(0, FIRST_PRESETS).map((each) => element("button", { class: "chip", title: presetText(each), "data-testid": `preset-${each.preset}`, onclick: () => this.apply(each.preset) }, translateServerText(each.label))),
      more,
    );
  }

  private apply(preset: string): void {
    void this.parts.server.command("entity.apply_preset", { indices: [...this.parts.selection.indices], preset });
  }

  private remember(): void {
    this.source = this.parts.selection.indices[0] ?? 0;
    this.update();
    const name = nameOf(this.parts.document.entity(this.source)!);
    this.parts.notices.tell({ level: "info", text: t("The values of {{name}} are ready", { name }), remedy: t("Select other things and choose “Paste values”.") });
  }

  private update(): void {
    const { selection, document } = this.parts;
    const source = document.entities.get(this.source);
    show(this.root, selection.indices.length > 0);
    show(this.copy, selection.indices.length === 1);
    show(this.paste, source !== undefined && selection.indices.some((index) => index !== this.source));
    if (source) this.paste.textContent = t("Paste values of {{name}}…", { name: nameOf(source) });
  }
}

/** What a material brings, and where that is from. */
function presetText({ values, source }: MaterialPreset): string {
  const lines = values.map(({ label, value, unit }) => `${translateServerText(label)} ${numberText(value)}${unit && unit !== "1" ? ` ${unit}` : ""}`);
  return `${lines.join("\n")}\n${translateServerText(source)}`;
}

/** Asks which values to give to the selection; those that a person set are ticked. */
async function openPaste(parts: ToolParts, from: number): Promise<void> {
  const told = await parts.server.command("entity.attributes", { index: from });
  const source = parts.document.entities.get(from);
  if (!told || !source) return;
  const indices = parts.selection.indices.filter((index) => index !== from);
  const offered = told.attributes.filter(({ name, overridden }) => overridden || USUALLY_COPIED.includes(name));
  const anySet = offered.some(({ overridden }) => overridden);
  const boxes = offered.map((entry) => {
    const box = element("input", { type: "checkbox", value: entry.name, "data-testid": `paste-${entry.name}`, onchange: () => update() });
    box.checked = anySet ? entry.overridden : entry.name === "surface_material";
    return { box, row: element("label", { class: "option" }, box, element("span", {}, translateServerText(entry.label)), element("span", { class: "note" }, entry.overridden ? t("{{value}}, set by hand", { value: entryText(entry) }) : entryText(entry))) };
  });
  const run = async (): Promise<void> => {
    const names = boxes.flatMap(({ box }) => (box.checked ? [box.value] : []));
    const done = await parts.server.command("entity.copy_attributes", { from, indices, names });
    if (!done) return;
    dialog.close();
    const left = new Set(done.skipped.map(({ label }) => translateServerText(label).toLowerCase()));
    if (left.size > 0) parts.notices.tell({ level: "info", text: t("{{names}} do not concern all of them and were left out there", { count: left.size, names: [...left].join(t(", ")) }) });
  };
  const go = element("button", { class: "primary", "data-testid": "paste-go", onclick: () => void run() });
  const update = (): void => {
    const count = boxes.filter(({ box }) => box.checked).length;
    go.disabled = count === 0;
    go.textContent = t("Give {{values}} to {{things}}", { values: t("{{count}} values", { count }), things: t("{{count}} things", { count: indices.length }) });
  };
  const dialog = openDialog(t("Values of {{name}}", { name: nameOf(source) }), "paste-values-dialog", element("div", { class: "options" }, ...boxes.map(({ row }) => row)), dialogButtons(element("button", { onclick: () => dialog.close() }, t("Cancel")), go));
  update();
}

function entryText({ value, name, unit }: AttributeEntry): string {
  return `${valueText(value, name)}${unit && unit !== "1" ? ` ${unitText(unit)}` : ""}`;
}
