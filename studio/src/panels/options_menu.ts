// SPDX-License-Identifier: MIT
import { DEBUG_NAMES, type DebugName } from "../connection/debug_frame";
import type { Parts } from "../parts";
import type { Preferences } from "../preferences";
import type { UserAction } from "../tools/actions";
import { openDialog } from "./dialogs";
import { element, setText, show } from "./element";
import { numberField } from "./fields";
import { userNameField } from "./user_name";
import type { Theme } from "../view/environment";
import type { Offer } from "../vr/offer";
import { t } from "../language";
import { chosenLanguage, chooseLanguage, type Language, LANGUAGES, TAGS } from "../language/choice";

const DEBUG_LABELS: Record<DebugName, string> = {
  shapes: t("Collision shapes"),
  bounds: t("Bounds"),
  contacts: t("Contacts"),
  impulses: t("Impulses"),
  islands: t("Islands"),
  joints: t("Joints"),
  masses: t("Centres of mass, inertia"),
  particles: t("Particles"),
  deformables: t("Nodes and edges"),
  trees: t("Broad phase"),
  velocities: t("Velocities"),
  forces: t("Forces"),
};

/** For example "1,234 lines and 56 points not drawn"; empty where all are drawn. */
function leftOutText({ lines, points }: { lines: number; points: number }): string {
  const parts = [lines > 0 && t("{{count, number}} lines", { count: lines }), points > 0 && t("{{count, number}} points", { count: points })].filter(Boolean);
  return parts.length === 0 ? "" : t("{{what}} not drawn", { what: parts.join(t(" and ")) });
}

/** Debug drawing: a checkbox for each kind, and how much did not fit into the frame. */
function debugList({ preferences, view }: Pick<Parts, "preferences" | "view">): { root: HTMLElement; end: () => void } {
  const line = (name: DebugName) => {
    const flip = () => preferences.set("debug", DEBUG_NAMES.filter((each) => preferences.get("debug").includes(each) !== (each === name)));
    const box = element("input", { type: "checkbox", "data-testid": `debug-${name}`, onchange: flip });
    box.checked = preferences.get("debug").includes(name);
    return element("label", { class: "option" }, box, element("span", {}, DEBUG_LABELS[name]));
  };
  const leftOut = element("p", { class: "note", "data-testid": "debug-left-out" });
  const tell = () => {
    const text = leftOutText(view.debug.leftOut);
    setText(leftOut, text);
    show(leftOut, text !== "");
  };
  tell();
  const root = element("fieldset", { class: "debug-options" }, element("legend", {}, t("See inside the simulation")), ...DEBUG_NAMES.map(line), leftOut);
  return { root, end: view.debug.changed.on(tell) };
}

function themeChoice(preferences: Preferences): HTMLElement {
  const choices = { system: t("as the system"), dark: t("dark"), light: t("light") };
  const shown = preferences.followsSystem ? "system" : preferences.get("theme");
  const choose = () => (select.value === "system" ? preferences.useSystemTheme() : preferences.set("theme", select.value as Theme));
  const select = element("select", { "data-testid": "option-theme", onchange: choose }, ...Object.entries(choices).map(([value, label]) => element("option", { value, selected: value === shown }, label)));
  return select;
}

/** The languages by their own names; a choice loads the page again. */
function languageChoice(): HTMLElement {
  const shown = chosenLanguage() ?? "";
  const names: [string, string][] = [["", t("as the system")], ...Object.entries(LANGUAGES)];
  const options = names.map(([value, label]) => element("option", { value, selected: value === shown, ...(value && { lang: TAGS[value as Language] }) }, label));
  const select = element("select", { "data-testid": "option-language", onchange: () => chooseLanguage((select.value || null) as Language | null) }, ...options);
  return select;
}

/** Options of drawing and snapping; kept in the browser. */
export function openOptions(parts: Pick<Parts, "preferences" | "server" | "view">, actions: readonly UserAction[], headset: Offer | null): void {
  const { preferences } = parts;
  const row = (label: string, field: HTMLElement) => element("label", { class: "option" }, field, element("span", {}, label));
  const flip = (id: string): HTMLElement | null => {
    const action = actions.find((each) => each.id === id);
    if (!action) return null;
    const box = element("input", { type: "checkbox", "data-testid": `option-${id}`, onchange: () => action.run() });
    box.checked = action.on?.() ?? false;
    return row(action.label, box);
  };
  const sounds = element("input", { type: "checkbox", "data-testid": "option-sounds", onchange: () => preferences.set("sounds", sounds.checked) });
  sounds.checked = preferences.get("sounds");
  const hint = headset?.why ? element("p", { class: "note", "data-testid": "vr-hint" }, t("Headset: {{why}}. {{remedy}}", { why: headset.why, remedy: headset.remedy })) : null;
  const step = numberField(t("Snap to"), "m", (value) => value > 0 && preferences.set("snapLength", value));
  const angle = numberField(t("Snap to"), "°", (value) => value > 0 && preferences.set("snapAngle", value));
  step.set(preferences.get("snapLength"));
  angle.set(preferences.get("snapAngle"));
  const pull = numberField(t("Strength of the mouse"), "N", (value) => value >= 1 && value <= 1e6 && preferences.set("pull", value), { step: 50 });
  pull.set(preferences.get("pull"));
  const inside = debugList(parts);
  const dialog = openDialog(
    t("View options"),
    "options-dialog",
    element(
      "div",
      { class: "options" },
      flip("view.tint"),
      flip("view.fullTint"),
      flip("view.grid"),
      flip("view.collision"),
      row(t("Sounds of impacts"), sounds),
      row(t("Language"), languageChoice()),
      row(t("Colours"), themeChoice(preferences)),
      flip("view.quality"),
      flip("tool.snap"),
      inside.root,
      row(t("Snapping step when moving"), step.root),
      row(t("Snapping step when rotating"), angle.root),
      row(t("How strongly the mouse pulls in a run: one arm has about 400"), pull.root),
      row(t("Your name in the history of changes"), userNameField(parts)),
      ...(hint ? [hint] : []),
    ),
  );
  dialog.addEventListener("close", inside.end);
}
