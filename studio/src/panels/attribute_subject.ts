// SPDX-License-Identifier: MIT
import type { AttributeEdit, AttributeEntry, AttributeValue } from "../connection/messages";
import type { Parts } from "../parts";
import type { Change } from "./fields";
import { t } from "../language";

/** Of a larger selection only so many entities are asked for, because asking for all would take long. */
const MOST_ASKED = 32;

/** The entities or the model whose attributes are shown and edited. */
export interface AttributeSubject {
  /** Rows are made anew for another id. */
  readonly id: string;
  /** The attributes of each entity; the note says what could not be loaded. */
  load(): Promise<{ sets: AttributeEntry[][]; note: string }>;
  /** Components of a vector or tensor that are null stay as they are in each entity. */
  set(name: string, value: AttributeEdit): Promise<unknown>;
  /** Changes the number that each has by its own, in one step of undo. */
  change(name: string, change: Change): Promise<unknown>;
  reset(name: string): Promise<unknown>;
  /** Keys of the catalogue's models that the entities have; empty where one of them has no model. */
  models(): string[];
}

/** The selection in the scene: edits change these entities only. */
export class SelectedEntities implements AttributeSubject {
  readonly id: string;
  private readonly indices: number[];

  constructor(private readonly parts: Pick<Parts, "server" | "document" | "selection">) {
    this.indices = [...parts.selection.indices];
    this.id = this.indices.join();
  }

  async load(): Promise<{ sets: AttributeEntry[][]; note: string }> {
    const asked = this.indices.slice(0, MOST_ASKED);
    const answers = await Promise.allSettled(asked.map((index) => this.parts.server.request("entity.attributes", { index })));
    const failed = answers.find((answer) => answer.status === "rejected");
    const many = this.indices.length > MOST_ASKED ? t("Values of the first {{asked}} of {{count}} entities; an edit changes all of them.", { asked: MOST_ASKED, count: this.indices.length }) : "";
    return {
      sets: answers.flatMap((answer) => (answer.status === "fulfilled" ? [answer.value.attributes] : [])),
      note: failed ? (failed.reason as Error).message : many,
    };
  }

  set(name: string, value: AttributeEdit): Promise<unknown> {
    return this.parts.server.request("entity.set_attribute", { indices: this.indices, name, value });
  }

  async change(name: string, change: Change): Promise<unknown> {
    const merge = `values-${Date.now()}`;
    const { server } = this.parts;
    // Asked anew: the shown values are those of the first entities only.
    const told = await Promise.all(this.indices.map((index) => server.request("entity.attributes", { index })));
    return Promise.all(
      told.flatMap(({ attributes }, at) => {
        const entry = attributes.find((each) => each.name === name);
        return entry && typeof entry.value === "number" ? [server.request("entity.set_attribute", { indices: [this.indices[at]!], name, value: change(entry.value), merge })] : [];
      }),
    );
  }

  reset(name: string): Promise<unknown> {
    return this.parts.server.request("entity.reset_attribute", { indices: this.indices, name });
  }

  models(): string[] {
    const keys = this.indices.map((index) => this.parts.document.entity(index)?.model);
    return keys.includes(undefined) ? [] : [...new Set(keys as string[])];
  }
}

/** The model picked in the catalogue: edits change the model itself, for every scene. */
export class CatalogueModel implements AttributeSubject {
  readonly id: string;

  constructor(
    private readonly parts: Pick<Parts, "server">,
    private readonly key: string,
  ) {
    this.id = `model ${key}`;
  }

  async load(): Promise<{ sets: AttributeEntry[][]; note: string }> {
    try {
      return { sets: [(await this.parts.server.request("catalog.model", { key: this.key })).attributes], note: "" };
    } catch (error) {
      return { sets: [], note: (error as Error).message };
    }
  }

  set(name: string, value: AttributeEdit): Promise<unknown> {
    // Of a single model every component is known.
    return this.parts.server.request("catalog.set_attribute", { key: this.key, name, value: value as AttributeValue });
  }

  /** One model has one value, which its field knows. */
  change(): Promise<unknown> {
    return Promise.resolve();
  }

  reset(name: string): Promise<unknown> {
    return this.parts.server.request("catalog.reset_attribute", { key: this.key, name });
  }

  models(): string[] {
    return [this.key];
  }
}
