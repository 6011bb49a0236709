// SPDX-License-Identifier: MIT
import type { SceneListing } from "../connection/messages";
import type { Parts } from "../parts";
import { element, show } from "./element";
import { icon } from "../tools/icons";

/** A modal dialog with a title; closes with Escape, its cross, or a click outside. */
export function openDialog(title: string, testId: string, ...contents: (Node | null)[]): HTMLDialogElement {
  const dialog = element(
    "dialog",
    { "aria-label": title, "data-testid": testId },
    element(
      "header",
      {},
      element("h2", {}, title),
      element("button", { class: "plain", "aria-label": "Close", onclick: () => dialog.close() }, icon("close")),
    ),
    ...contents,
  );
  dialog.addEventListener("close", () => dialog.remove());
  dialog.addEventListener("click", (event) => {
    if (event.target === dialog) dialog.close();
  });
  document.body.append(dialog);
  dialog.showModal();
  return dialog;
}

/** Asks before unsaved changes are lost; true at once where there are none. */
export function mayLeave(parts: Pick<Parts, "document">): Promise<boolean> {
  if (!parts.document.unsaved) return Promise.resolve(true);
  return new Promise((resolve) => {
    let answer = false;
    const dialog = openDialog(
      "The scene has unsaved changes",
      "unsaved-dialog",
      element("p", {}, "They will be lost when another scene is opened."),
      element(
        "div",
        { class: "dialog-buttons" },
        element("button", { onclick: () => dialog.close() }, "Cancel"),
        element("button", { class: "danger", "data-testid": "discard", onclick: () => ((answer = true), dialog.close()) }, "Discard changes"),
      ),
    );
    dialog.addEventListener("close", () => resolve(answer));
  });
}

export async function newScene(parts: Pick<Parts, "server" | "document">): Promise<void> {
  if (await mayLeave(parts)) await parts.server.command("scene.new", {});
}

/** Opens a scene from a file of the user's computer; the server reports errors in it with file, line and field. */
export async function openSceneFile(parts: Pick<Parts, "server" | "document">, file: File): Promise<void> {
  if (!(await mayLeave(parts))) return;
  await parts.server.command("scene.load", { text: await file.text(), file: file.name });
}

/** Lists the user's saved scenes and the demo scenes. */
export async function openScenes(parts: Pick<Parts, "server" | "document">): Promise<void> {
  const waiting = element("p", { class: "note" }, "Loading…");
  const body = element("div", { class: "scene-lists" }, waiting);
  const file = element("input", { type: "file", accept: ".json,application/json", hidden: true });
  const fromFile = element("button", { onclick: () => file.click() }, "Open a scene file…");
  const dialog = openDialog("Open a scene", "scenes-dialog", body, element("div", { class: "dialog-buttons" }, file, fromFile));

  const load = async (name: string): Promise<void> => {
    dialog.close();
    if (await mayLeave(parts)) await parts.server.command("scene.load", { name });
  };
  file.addEventListener("change", () => {
    const chosen = file.files?.[0];
    if (!chosen) return;
    dialog.close();
    void openSceneFile(parts, chosen);
  });

  const answer = await parts.server.command("scene.list", {});
  if (!answer) return dialog.close();
  const list = (title: string, kind: SceneListing["kind"], none: string) => {
    const scenes = answer.scenes.filter((scene) => scene.kind === kind);
    const items = scenes.map((scene) =>
      element(
        "li",
        {},
        element(
          "button",
          { class: "scene-item", "data-testid": `scene-${scene.name}`, onclick: () => void load(scene.name) },
          element("span", {}, scene.title || scene.name),
          // The date of a demo scene is of no use to the user.
          kind === "demo" ? null : element("span", { class: "note" }, [nameBeside(scene), dateText(scene.modified)].filter(Boolean).join(" · ")),
        ),
      ),
    );
    return element("section", {}, element("h3", {}, title), items.length > 0 ? element("ul", {}, ...items) : element("p", { class: "note" }, none));
  };
  const recovered = answer.scenes.some((scene) => scene.kind === "recovery");
  body.replaceChildren(
    list("Saved", "saved", "Nothing saved yet. Ctrl+S saves."),
    list("Examples", "demo", "No examples found."),
    ...(recovered ? [list("Recovered (kept automatically, never saved)", "recovery", "")] : []),
  );
  body.querySelector<HTMLElement>("button")?.focus();
}

/** The name that a scene is saved under, where it differs from the title. */
function nameBeside({ kind, name, title }: SceneListing): string {
  return kind === "saved" && title && title !== name ? name : "";
}

function dateText(modified: SceneListing["modified"]): string {
  if (!modified) return "";
  const date = new Date(modified);
  return Number.isNaN(date.getTime()) ? "" : date.toLocaleString([], { dateStyle: "medium", timeStyle: "short" });
}

export function saveAs(parts: Pick<Parts, "server" | "notices" | "document">): void {
  const name = element("input", { type: "text", value: parts.document.name || parts.document.title, "aria-label": "Name", "data-testid": "save-name" });
  const error = element("p", { class: "field-error", role: "alert" });
  show(error, false);
  const form = element(
    "form",
    {
      onsubmit: async (event: Event) => {
        event.preventDefault();
        try {
          const saved = await parts.server.request("scene.save", { name: name.value.trim() });
          dialog.close();
          parts.notices.tell({ level: "info", text: `Saved “${saved.name}”`, remedy: saved.path });
        } catch (reason) {
          error.textContent = (reason as Error).message;
          show(error, true);
        }
      },
    },
    element("label", {}, "Name", name),
    error,
    element("div", { class: "dialog-buttons" }, element("button", { type: "button", onclick: () => dialog.close() }, "Cancel"), element("button", { class: "primary", type: "submit" }, "Save")),
  );
  const dialog = openDialog("Save the scene", "save-dialog", form);
  name.focus();
  name.select();
}
