// SPDX-License-Identifier: MIT
import { DEBUG_NAMES, type DebugName } from "../connection/debug_frame";
import type { Parts } from "../parts";
import type { UserAction } from "../tools/actions";
import { openDialog } from "./dialogs";
import { element } from "./element";
import { numberField } from "./fields";
import { userNameField } from "./user_name";

const DEBUG_LABELS: Record<DebugName, string> = {
  shapes: "Collision shapes",
  bounds: "Bounds",
  contacts: "Contacts",
  impulses: "Impulses",
  islands: "Islands",
  joints: "Joints",
  masses: "Centres of mass, inertia",
  particles: "Particles",
  deformables: "Nodes and edges",
  trees: "Broad phase",
};

/** What the solver sees: a box to tick for each. */
function debugList({ preferences }: Pick<Parts, "preferences">): HTMLElement {
  const line = (name: DebugName) => {
    const flip = () => preferences.set("debug", DEBUG_NAMES.filter((each) => preferences.get("debug").includes(each) !== (each === name)));
    const box = element("input", { type: "checkbox", "data-testid": `debug-${name}`, onchange: flip });
    box.checked = preferences.get("debug").includes(name);
    return element("label", { class: "option" }, box, element("span", {}, DEBUG_LABELS[name]));
  };
  return element("fieldset", { class: "debug-options" }, element("legend", {}, "See inside the simulation"), ...DEBUG_NAMES.map(line));
}

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
      debugList(parts),
      row("Snapping step when moving", step.root),
      row("Snapping step when rotating", angle.root),
      row("Your name in the history of changes", userNameField(parts)),
    ),
  );
}
