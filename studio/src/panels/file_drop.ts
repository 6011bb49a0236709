// SPDX-License-Identifier: MIT
import type { ServerError } from "../connection/messages";
import { entityOf } from "../document/entity_of_model";
import type { Parts } from "../parts";
import { addUnder } from "../tools/ghost";
import { openScene, openSceneFile } from "./scene_dialogs";
import { t, translateServerText } from "../language";

const LARGEST_BYTES = 256 * 1024 * 1024;

interface ImportAnswer {
  added: number;
  updated: number;
  unchanged: number;
  failures: { path: string; why: string }[];
  keys: string[];
  /** Of a home of Sweet Home 3D: its plan as a scene, and what is not as in the home. */
  scene?: unknown;
  notes?: string[];
}

/** Files from the desktop: scenes are opened; models are imported, and added to the scene where they were dropped. */
export class FileDrop {
  constructor(
    private readonly parts: Pick<Parts, "server" | "notices" | "document" | "opening" | "selection" | "models" | "view">,
    private readonly imported: () => void,
  ) {
    const hasFiles = (event: DragEvent) => event.dataTransfer?.types.includes("Files") ?? false;
    addEventListener("dragover", (event) => {
      if (!hasFiles(event)) return;
      event.preventDefault();
      document.body.classList.add("dropping");
    });
    addEventListener("dragleave", (event) => {
      if (event.relatedTarget === null) document.body.classList.remove("dropping");
    });
    addEventListener("drop", (event) => {
      document.body.classList.remove("dropping");
      if (!hasFiles(event)) return;
      event.preventDefault();
      void this.take([...event.dataTransfer!.files], event.clientX, event.clientY);
    });
  }

  private async take(files: File[], clientX: number, clientY: number): Promise<void> {
    for (const file of files) {
      if (file.name.toLowerCase().endsWith(".json")) {
        await openSceneFile(this.parts, file);
        continue;
      }
      const keys = await this.import(file);
      this.imported();
      const overScene = document.elementFromPoint(clientX, clientY)?.closest("#scene");
      if (!overScene) continue;
      for (const key of keys.slice(0, 1)) await addUnder(this.parts, entityOf(await this.parts.models.summary(key)), clientX, clientY);
    }
  }

  /** Uploads the file to the database; returns the keys of its models. */
  private async import(file: File): Promise<string[]> {
    const { notices, server } = this.parts;
    if (file.size > LARGEST_BYTES) {
      notices.tell({ level: "error", text: t("{{name}} is larger than 256 MiB", { name: file.name }), remedy: t("Import it with “embody import FILE”.") });
      return [];
    }
    notices.tell({ level: "info", text: t("Importing {{name}}…", { name: file.name }) });
    try {
      const answer = await fetch(server.address(`import?name=${encodeURIComponent(file.name)}`), { method: "POST", body: file });
      const report = (await answer.json()) as ImportAnswer & { error?: ServerError };
      if (report.error) {
        notices.tell({ level: "error", text: `${report.error.where}: ${translateServerText(report.error.why)}`, remedy: report.error.remedy });
        return [];
      }
      for (const failure of report.failures) notices.tell({ level: "error", text: `${failure.path}: ${translateServerText(failure.why)}` });
      for (const note of report.notes ?? []) notices.tell({ level: "info", text: `${file.name}: ${translateServerText(note)}` });
      if (report.scene) {
        await openScene(this.parts, { scene: report.scene });
        return [];
      }
      if (report.failures.length === 0) notices.tell({ level: "info", text: t("{{name}} is in the model database", { name: file.name }) });
      return report.keys ?? [];
    } catch (error) {
      notices.tell({ level: "error", text: t("{{name}} was not imported: {{message}}", { name: file.name, message: (error as Error).message }) });
      return [];
    }
  }
}
