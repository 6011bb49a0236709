// SPDX-License-Identifier: MIT
// New, open, save: what opens another scene goes through openScene(), so that unsaved work and the others are thought of.
import { reasonText } from "../connection/connection";
import type { Commands, SceneListing } from "../connection/messages";
import type { Parts } from "../parts";
import { dateText, dialogButtons, openDialog, openTextDialog } from "./dialogs";
import { element } from "./element";
import { discardRecovery, editsText } from "./recovery";
import { dateLocale, t, translateServerText } from "../language";

type Opener = Pick<Parts, "server" | "notices" | "document" | "opening" | "view">;

/** Asks before unsaved changes are left; true at once where there are none. */
function mayLeave(parts: Opener): Promise<boolean> {
  const { document: scene } = parts;
  if (!scene.unsaved) return Promise.resolve(true);
  return new Promise((resolve) => {
    let answer = false;
    const leave = (): void => {
      answer = true;
      dialog.close();
    };
    const saveFirst = async (): Promise<void> => {
      if (await saveScene(parts)) leave();
    };
    const dialog = openDialog(
      t("The scene has unsaved changes"),
      "unsaved-dialog",
      element("p", {}, t("“{{title}}” is then kept as it is among the recovered scenes, where “Open a scene” finds it.", { title: scene.title })),
      dialogButtons(
        element("button", { onclick: () => dialog.close() }, t("Cancel")),
        element("button", { "data-testid": "save-first", onclick: () => void saveFirst() }, t("Save first")),
        element("button", { class: "primary", "data-testid": "leave-scene", onclick: leave }, t("Leave and keep it")),
      ),
    );
    dialog.addEventListener("close", () => resolve(answer));
  });
}

/** Opens a scene, after asking whether unsaved work may be left; where others are here, the server asks them. */
export async function openScene(parts: Opener, params: Commands["scene.load"][0]): Promise<void> {
  if (!(await mayLeave(parts))) return;
  const result = await parts.server.command("scene.load", params);
  if (result) parts.opening.wait(result);
}

export async function newScene(parts: Opener): Promise<void> {
  if (!(await mayLeave(parts))) return;
  const result = await parts.server.command("scene.new", {});
  if (result) parts.opening.wait(result);
}

/** Opens a recovered scene. */
export function openRecovery(parts: Opener, name: string): Promise<void> {
  return openScene(parts, { name });
}

/** Opens a scene from a file of the user's computer; the server reports errors in it with file, line and field. */
export async function openSceneFile(parts: Opener, file: File): Promise<void> {
  await openScene(parts, { text: await file.text(), file: file.name });
}

/** Lists the user's saved scenes, the demo scenes and what was recovered. */
export async function openScenes(parts: Opener): Promise<void> {
  const body = element("div", { class: "scene-lists" }, element("p", { class: "note" }, t("Loading…")));
  const file = element("input", { type: "file", accept: ".json,application/json", hidden: true });
  const fromFile = element("button", { onclick: () => file.click() }, t("Open a scene file…"));
  const dialog = openDialog(t("Open a scene"), "scenes-dialog", body, dialogButtons(file, fromFile));
  dialog.classList.add("wide");
  const load = (name: string): void => {
    dialog.close();
    void openScene(parts, { name });
  };
  file.addEventListener("change", () => {
    const chosen = file.files?.[0];
    if (!chosen) return;
    dialog.close();
    void openSceneFile(parts, chosen);
  });

  const fill = async (): Promise<boolean> => {
    const answer = await parts.server.command("scene.list", {});
    if (!answer) return false;
    const of = (kind: SceneListing["kind"]) => answer.scenes.filter((scene) => scene.kind === kind);
    const list = (title: string, kind: SceneListing["kind"], none: string) => {
      const items = of(kind).map((scene) => sceneItem(scene, load, () => void discard(scene.name)));
      return element("section", {}, element("h3", {}, title), items.length > 0 ? element("ul", {}, ...items) : element("p", { class: "note" }, none));
    };
    const recovered = answer.scenes.some((scene) => scene.kind === "recovery");
    body.replaceChildren(
      element("div", {}, list(t("Saved"), "saved", t("Nothing saved yet. Ctrl+S saves.")), recovered ? list(t("Recovered, never saved"), "recovery", "") : null),
      element("section", {}, element("h3", {}, t("Examples")), gallery(of("demo"), load)),
    );
    return true;
  };
  const discard = async (name: string): Promise<void> => {
    await discardRecovery(parts, name);
    await fill();
  };
  if (!(await fill())) return dialog.close();
  body.querySelector<HTMLElement>("button")?.focus();
}

/** A card with a picture for each example. */
function gallery(scenes: readonly SceneListing[], load: (name: string) => void): HTMLElement {
  if (scenes.length === 0) return element("p", { class: "note" }, t("No examples found."));
  const card = ({ name, title, description }: SceneListing): HTMLElement => {
    const picture = element("img", { src: `gallery/${name}.webp`, alt: "", width: 320, height: 200, loading: "lazy" });
    // An example that was added by hand has none.
    picture.addEventListener("error", () => picture.classList.add("missing"));
    return element("li", {}, element("button", { class: "gallery-card", "data-testid": `scene-${name}`, onclick: () => load(name) }, picture, element("strong", {}, translateServerText(title || name)), element("span", { class: "note" }, translateServerText(description ?? ""))));
  };
  return element("ul", { class: "gallery", "data-testid": "gallery" }, ...scenes.map(card));
}

function sceneItem(scene: SceneListing, load: (name: string) => void, discard: () => void): HTMLElement {
  const { name, kind, modified } = scene;
  const note = [nameBeside(scene), dateText(modified), kind === "recovery" ? editsText(scene.edits) : ""].filter(Boolean).join(" · ");
  const open = element(
    "button",
    { class: "scene-item", "data-testid": `scene-${name}`, onclick: () => load(name) },
    element("span", {}, scene.title || name),
    note ? element("span", { class: "note" }, note) : null,
  );
  if (kind !== "recovery") return element("li", {}, open);
  const button = element("button", { "data-testid": `discard-${name}`, "aria-label": t("Discard {{name}}", { name: scene.title || name }), onclick: discard }, t("Discard"));
  return element("li", { class: "recovery-row" }, open, button);
}

/** The name that a scene is saved under, where it differs from the title. */
function nameBeside({ kind, name, title }: SceneListing): string {
  return kind === "saved" && title && title !== name ? name : "";
}

/** Saves the scene with the camera as it is; a scene without a name asks for one. Whether it was saved. */
export async function saveScene(parts: Pick<Parts, "server" | "notices" | "document" | "view">): Promise<boolean> {
  if (!parts.document.name) return saveAs(parts);
  const saved = await parts.server.command("scene.save", { camera: parts.view.rig.seen() });
  if (saved) parts.notices.tell({ level: "info", text: t("Saved “{{name}}”", { name: saved.name }) });
  return saved !== undefined;
}

/** Saves the scene under a name that the user gives; whether they did. */
export function saveAs(parts: Pick<Parts, "server" | "notices" | "document" | "view">): Promise<boolean> {
  const value = parts.document.name || parts.document.title;
  let isSaved = false;
  const dialog = openTextDialog(t("Save the scene"), { label: t("Name"), value, action: t("Save"), testId: "save", note: t("It opens again as you see it now.") }, async (name) => {
    try {
      const saved = await parts.server.request("scene.save", { name, camera: parts.view.rig.seen() });
      parts.notices.tell({ level: "info", text: t("Saved “{{name}}”", { name: saved.name }), remedy: saved.path });
      isSaved = true;
      return null;
    } catch (error) {
      return reasonText(error as Error);
    }
  });
  return new Promise((resolve) => dialog.addEventListener("close", () => resolve(isSaved)));
}

/** Keeps a copy of the scene as it is now under a name of its own. */
export function saveVersion(parts: Pick<Parts, "server" | "notices" | "document" | "view">): void {
  const { document: scene } = parts;
  const value = `${scene.title}, ${new Date().toLocaleDateString(dateLocale, { day: "numeric", month: "short" })}`;
  const note = t("The scene is saved too. “Versions of this scene” lists all.");
  openTextDialog(t("Save a version"), { label: t("What this version is called"), value, action: t("Save version"), testId: "version", note }, async (version) => {
    if (version === "") return t("A version needs a name, such as “before the move”.");
    try {
      const name = scene.name || scene.title;
      const saved = await parts.server.request("scene.save", { name, version, camera: parts.view.rig.seen() });
      parts.notices.tell({ level: "info", text: t("Saved “{{name}}” and its version “{{version}}”", { name: saved.name, version }) });
      return null;
    } catch (error) {
      return reasonText(error as Error);
    }
  });
}

/** Lists the versions of the open scene, the newest first. */
export async function openVersions(parts: Opener): Promise<void> {
  const { name } = parts.document;
  const answer = name ? await parts.server.command("scene.versions", { name }) : { versions: [] };
  if (!answer) return;
  const versions = [...answer.versions].sort((a, b) => (b.modified ?? "").localeCompare(a.modified ?? ""));
  const load = (version: string): void => {
    dialog.close();
    void openScene(parts, { name, version });
  };
  const items = versions.map(({ version, modified }) =>
    element(
      "li",
      {},
      element(
        "button",
        { class: "scene-item", "data-testid": `version-${version}`, onclick: () => load(version) },
        element("span", {}, version),
        element("span", { class: "note" }, dateText(modified)),
      ),
    ),
  );
  const save = element("button", { onclick: () => (dialog.close(), saveVersion(parts)) }, t("Save a version…"));
  const none = element("p", { class: "note" }, t("This scene has no versions yet. A version is a copy under a name, to come back to."));
  const dialog = openDialog(t("Versions of this scene"), "versions-dialog", items.length > 0 ? element("ul", {}, ...items) : none, dialogButtons(save));
}
