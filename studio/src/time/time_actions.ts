// SPDX-License-Identifier: MIT
import type { Parts } from "../parts";
import type { UserAction } from "../tools/actions";
import { openFilm } from "./film_dialog";
import { openPicture } from "./picture_dialog";
import type { Recorder } from "./recorder";
import { t } from "../language";

/** What can be done with a moment of the run. */
export function timeActions(parts: Pick<Parts, "server" | "notices" | "document" | "motion" | "entities" | "take" | "preferences" | "view">, recorder: Recorder, keep: () => void): UserAction[] {
  const { take, preferences } = parts;
  const looksBack = () => take.state.shown !== null;
  return [
    { id: "time.branch", label: t("Branch from here: forget what came after and go on from this moment"), short: t("Branch from here"), group: t("Time"), keys: [], icon: "branch", possible: looksBack, run: () => void branch(parts) },
    { id: "time.keep", label: t("Keep this moment: the scene begins as it was then"), short: t("Keep this moment"), group: t("Time"), keys: [], icon: "keep", possible: () => take.isThere, run: keep },
    { id: "time.plots", label: t("Plot the selected things over the run"), short: t("Plots"), group: t("Time"), keys: [], icon: "plot", possible: () => take.isThere, on: () => preferences.get("plots"), run: () => preferences.set("plots", !preferences.get("plots")) },
    { id: "time.film", label: t("Make a film of the run…"), short: t("Film…"), group: t("Time"), keys: [], icon: "film", possible: () => take.isThere, run: () => openFilm(parts, () => recorder.open()) },
    { id: "time.record", label: t("Record what I do…"), group: t("Time"), keys: [], icon: "film", on: () => recorder.isRunning, run: () => (recorder.isRunning ? void recorder.end() : recorder.open()) },
    { id: "view.picture", label: t("Save a picture of any size…"), group: t("View"), keys: [], icon: "camera", run: () => openPicture(parts) },
  ];
}

async function branch({ server, notices }: Pick<Parts, "server" | "notices">): Promise<void> {
  const done = await server.command("time.branch", {});
  if (!done) return;
  const remedy = done.notes.length > 0 ? t("Not as it was: {{notes}}.", { notes: done.notes.join("; ") }) : undefined;
  notices.tell({ level: "info", text: t("The run goes on from {{time}} s", { time: done.time.toFixed(2) }), ...(remedy && { remedy }) });
}
