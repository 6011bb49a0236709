// SPDX-License-Identifier: MIT
import type { Parts } from "../parts";
import type { UserAction } from "../tools/actions";
import { openFilm } from "./film_dialog";
import { openPicture } from "./picture_dialog";

/** What can be done with a moment of the run. */
export function timeActions(parts: Pick<Parts, "server" | "notices" | "document" | "motion" | "entities" | "take" | "preferences" | "view">, keep: () => void): UserAction[] {
  const { take, preferences } = parts;
  const looksBack = () => take.state.shown !== null;
  return [
    { id: "time.branch", label: "Branch from here: forget what came after and go on from this moment", short: "Branch from here", group: "Time", keys: [], icon: "branch", possible: looksBack, run: () => void branch(parts) },
    { id: "time.keep", label: "Keep this moment: its poses become the scene's", short: "Keep this moment", group: "Time", keys: [], icon: "keep", possible: () => take.isThere, run: keep },
    { id: "time.plots", label: "Plot the selected things over the run", short: "Plots", group: "Time", keys: [], icon: "plot", possible: () => take.isThere, on: () => preferences.get("plots"), run: () => preferences.set("plots", !preferences.get("plots")) },
    { id: "time.film", label: "Make a film of the run…", short: "Film…", group: "Time", keys: [], icon: "film", possible: () => take.isThere, run: () => openFilm(parts) },
    { id: "view.picture", label: "Save a picture of any size…", group: "View", keys: [], icon: "camera", run: () => openPicture(parts) },
  ];
}

async function branch({ server, notices }: Pick<Parts, "server" | "notices">): Promise<void> {
  const done = await server.command("time.branch", {});
  if (!done) return;
  const remedy = done.notes.length > 0 ? `Not as it was: ${done.notes.join("; ")}.` : undefined;
  notices.tell({ level: "info", text: `The run goes on from ${done.time.toFixed(2)} s`, ...(remedy && { remedy }) });
}
