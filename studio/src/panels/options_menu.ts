// SPDX-License-Identifier: MIT
import type { Parts } from "../parts";
import type { UserAction } from "../tools/actions";
import { openDialog } from "./dialogs";
import { element } from "./element";
import { numberField } from "./fields";
import { userNameField } from "./user_name";

/** How the picture looks and how snapping works; kept in the browser. */
export function openOptions(parts: Pick<Parts, "preferences" | "server">, actions: readonly UserAction[]): void {
  const { preferences } = parts;
  const row = (label: string, field: HTMLElement) => element("label", { class: "option" }, field, element("span", {}, label));
  const flip = (id: string): HTMLElement | null => {
    const action = actions.find((each) => each.id === id);
    if (!action) return null;
    const box = element("input", { type: "checkbox", "data-testid": `option-${id}`, onchange: () => action.run() });
    box.checked = action.on?.() ?? false;
    return row(action.label, box);
  };
  const step = numberField("Snap to", "m", (value) => value > 0 && preferences.set("snapLength", value));
  const angle = numberField("Snap to", "°", (value) => value > 0 && preferences.set("snapAngle", value));
  step.set(preferences.get("snapLength"));
  angle.set(preferences.get("snapAngle"));
  openDialog(
    "View options",
    "options-dialog",
    element(
      "div",
      { class: "options" },
      flip("view.tint"),
      flip("view.fullTint"),
      flip("view.grid"),
      flip("view.collision"),
      flip("view.theme"),
      flip("view.quality"),
      flip("tool.snap"),
      row("Snapping step when moving", step.root),
      row("Snapping step when rotating", angle.root),
      row("Your name in the history of changes", userNameField(parts)),
    ),
  );
}
