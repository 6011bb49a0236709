// SPDX-License-Identifier: MIT
import { Vector3 } from "three";
import type { Vector } from "../connection/scene_types";
import { withTyped } from "../document/components";
import type { Parts } from "../parts";
import { BoxPreview } from "../view/box_preview";
import { element, setText } from "./element";
import { vectorField } from "./fields";
import { t } from "../language";

/** More boxes would hide the picture; the server decides how many copies there may be. */
const MOST_SHOWN = 2000;
/** The gap between copies at first, m. */
const GAP = 0.05;

type ArrayParts = Pick<Parts, "server" | "selection" | "entities" | "view">;

/** Rows, columns and layers of copies of the selection: how many and how far apart, shown in the picture before they are made. */
export class ArrayCard {
  readonly root = element("div", { class: "card array-card", role: "dialog", "aria-label": t("Copies in rows"), "data-testid": "array-card", hidden: true });
  private readonly preview = new BoxPreview();
  private counts: Vector = [3, 1, 1];
  private spacing: Vector = [1, 1, 1];
  private readonly said = element("p", { class: "note", "data-testid": "array-count" });
  private readonly countField = vectorField([t("Copies along x"), t("Copies along y"), t("Copies along z")], "", (typed) => this.put({ counts: withTyped(this.counts, typed) as Vector }), 1);
  private readonly spacingField = vectorField([t("Distance along x"), t("Distance along y"), t("Distance along z")], "m", (typed) => this.put({ spacing: withTyped(this.spacing, typed) as Vector }), 0.05);

  constructor(private readonly parts: ArrayParts) {
    const row = (label: string, field: HTMLElement, help: string) => element("div", { class: "attribute" }, element("span", { class: "attribute-label", title: help }, label), field);
    this.root.append(
      element("strong", {}, t("Copies in rows")),
      row(t("How many"), this.countField.root, t("Along X, upwards, and along Z; what is selected is the first")),
      row(t("Distance"), this.spacingField.root, t("From one to the next; negative: the other way")),
      this.said,
      element("div", { class: "dialog-buttons" }, element("button", { onclick: () => this.close() }, t("Cancel")), element("button", { class: "primary", "data-testid": "array-make", onclick: () => void this.make() }, t("Add the copies"))),
    );
    this.root.addEventListener("keydown", (event) => event.key === "Escape" && (event.stopPropagation(), this.close()));
    parts.selection.changed.on(() => this.close());
    parts.view.scene.add(this.preview.group);
  }

  /** Boxes that the picture shows, for tests. */
  get shown(): number {
    return this.preview.count;
  }

  open(): void {
    const box = this.box();
    if (box.isEmpty()) return;
    const size = box.getSize(new Vector3());
    this.root.hidden = false;
    this.put({ spacing: size.toArray().map((length) => Math.ceil((length + GAP) * 100) / 100) as Vector });
    this.root.querySelector("input")?.focus();
  }

  private box() {
    return this.parts.entities.boundsOf([...this.parts.selection.indices], performance.now());
  }

  private close(): void {
    if (this.root.hidden) return;
    this.root.hidden = true;
    this.preview.show(this.box(), []);
    this.parts.view.invalidate();
  }

  private put({ counts = this.counts, spacing = this.spacing }: { counts?: Vector; spacing?: Vector }): void {
    this.counts = counts;
    this.spacing = spacing;
    this.countField.set(counts);
    this.spacingField.set(spacing);
    const [x, y, z] = counts.map((count) => Math.max(Math.floor(count), 1)) as Vector;
    const offsets: Vector3[] = [];
    for (let at = 1; at < x * y * z && offsets.length < MOST_SHOWN; ++at)
      offsets.push(new Vector3((at % x) * spacing[0], Math.floor(at / x / z) * spacing[1], (Math.floor(at / x) % z) * spacing[2]));
    this.preview.show(this.box(), offsets);
    const copies = (x * y * z - 1) * this.parts.selection.indices.length;
    setText(this.said, t("{{count, number}} copies will be added, drawn as boxes.", { count: copies }));
    this.parts.view.invalidate();
  }

  private async make(): Promise<void> {
    const { server, selection } = this.parts;
    const first = [...selection.indices];
    const made = await server.command("entity.array", { indices: first, counts: this.counts, spacing: this.spacing });
    if (!made) return;
    this.close();
    selection.set([...first, ...made.indices]);
  }
}
