// SPDX-License-Identifier: MIT
import type { Parts } from "../parts";
import type { UserAction } from "../tools/actions";
import { icon } from "../tools/icons";
import { element, show } from "./element";
import { t } from "../language";

const GROUPS = [
  ["arrange.align.x.low", "arrange.align.x.center", "arrange.align.x.high"],
  ["arrange.align.z.low", "arrange.align.z.center", "arrange.align.z.high"],
  ["arrange.align.y.low", "arrange.align.y.high"],
  ["arrange.distribute.x", "arrange.distribute.z"],
  ["arrange.mirror.x", "arrange.mirror.z"],
  ["arrange.array", "arrange.group", "arrange.ungroup"],
];

/** A small bar over the picture while several things are selected. */
export class ArrangeBar {
  readonly root: HTMLElement;
  private readonly buttons = new Map<UserAction, HTMLButtonElement>();

  constructor(
    private readonly parts: Pick<Parts, "document" | "selection" | "view">,
    actions: readonly UserAction[],
  ) {
    const find = (id: string) => actions.find((action) => action.id === id);
    this.root = element(
      "div",
      { class: "arrange-bar", role: "toolbar", "aria-label": t("Arrange"), "data-testid": "arrange-bar" },
      ...GROUPS.map((ids) => element("div", { class: "tool-group", role: "group" }, ...ids.flatMap((id) => find(id) ?? []).map((action) => this.button(action)))),
    );
    parts.selection.changed.on(() => this.refresh());
    parts.document.changed.on(() => this.refresh());
    this.refresh();
  }

  private button(action: UserAction): HTMLButtonElement {
    const run = (event: MouseEvent): void => {
      action.run();
      if (event.detail > 0) this.parts.view.canvas.focus();
    };
    const title = action.keys[0] ? `${action.label} (${action.keys[0]})` : action.label;
    const button = element("button", { class: "tool-button", title, "aria-label": action.label, "data-testid": action.id, onclick: run }, icon(action.icon ?? "options"));
    this.buttons.set(action, button);
    return button;
  }

  private refresh(): void {
    show(this.root, this.parts.selection.indices.length > 1);
    for (const [action, button] of this.buttons) button.disabled = !(action.possible?.() ?? true);
  }
}
