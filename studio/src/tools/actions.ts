// SPDX-License-Identifier: MIT
import type { IconName } from "./icons";
import type { Parts } from "../parts";
import { arrangeActions } from "./arrange_actions";
import { clipboardActions } from "./clipboard";
import { addInFront } from "./ghost";
import type { Gizmo } from "./gizmo";
import { allLocked, toggleLock, unlocked, withoutLocked } from "./locks";
import type { Pointer } from "./pointer";
import { PRIMITIVES } from "./primitives";
import { t } from "../language";

/** A command for the user: by button, key or command palette. */
export interface UserAction {
  id: string;
  label: string;
  /** For a button with words; missing: the label. */
  short?: string;
  group: string;
  /** Names as keyName() writes them; the first is shown. */
  keys: string[];
  icon?: IconName;
  /** The browser itself does it on this key, by an event of its own. */
  native?: boolean;
  /** Holding the key down does it again and again. */
  repeats?: boolean;
  /** The right that it needs, beyond looking. */
  needs?: "edit" | "run";
  /** Whether the action can be used now; missing: always. */
  possible?: () => boolean;
  /** For switches: whether it is on. */
  on?: () => boolean;
  run: () => void;
}

/** Functions that open dialogs and panels; the panels provide them. */
export interface Openers {
  scenes(): void;
  save(): void;
  saveAs(): void;
  saveVersion(): void;
  versions(): void;
  help(): void;
  palette(): void;
  search(): void;
  newScene(): void;
  history(): void;
}

export function makeActions(parts: Pick<Parts, "preferences" | "server" | "notices" | "document" | "people" | "playback" | "selection" | "picked" | "entities" | "view" | "framing">, gizmo: Gizmo, pointer: Pick<Pointer, "last">, open: Openers): UserAction[] {
  return withRights(parts, [
    ...sceneActions(parts, open),
    ...editActions(parts, open),
    ...clipboardActions(parts, pointer),
    ...arrangeActions(parts),
    ...toolActions(parts, gizmo),
    ...simulationActions(parts),
    ...viewActions(parts, open),
    ...PRIMITIVES.map((primitive) => ({
      id: `add.${primitive.name}`,
      label: t("Add {{label}}", { label: primitive.label.toLocaleLowerCase() }),
      group: t("Add"),
      keys: [],
      needs: "edit" as const,
      run: () => void addInFront(parts, primitive.entity()),
    })),
  ]);
}

/** What the user has no right to is not possible. */
function withRights({ people }: Pick<Parts, "people">, actions: UserAction[]): UserAction[] {
  return actions.map((action) => {
    const { needs, possible } = action;
    return needs ? { ...action, possible: () => people.rights[needs] && (possible?.() ?? true) } : action;
  });
}

function sceneActions(parts: Pick<Parts, "server">, open: Openers): UserAction[] {
  return [
    { id: "scene.new", needs: "edit", label: t("New scene"), group: t("Scene"), keys: [], icon: "fresh", run: open.newScene },
    { id: "scene.open", needs: "edit", label: t("Open scene…"), group: t("Scene"), keys: ["Ctrl+O"], icon: "open", run: open.scenes },
    { id: "scene.save", needs: "edit", label: t("Save"), group: t("Scene"), keys: ["Ctrl+S"], icon: "save", run: open.save },
    { id: "scene.save_as", needs: "edit", label: t("Save as…"), group: t("Scene"), keys: ["Ctrl+Shift+S"], run: open.saveAs },
    { id: "scene.save_version", needs: "edit", label: t("Save a version…"), group: t("Scene"), keys: [], run: open.saveVersion },
    { id: "scene.versions", label: t("Versions of this scene…"), group: t("Scene"), keys: [], run: open.versions },
    {
      id: "scene.download",
      label: t("Download scene file"),
      group: t("Scene"),
      keys: [],
      run: () => location.assign(parts.server.address("scene.json")),
    },
  ];
}

function editActions(parts: Pick<Parts, "server" | "notices" | "document" | "selection" | "picked" | "entities">, open: Openers): UserAction[] {
  const { selection, document } = parts;
  const some = () => selection.indices.length > 0;
  const forUnlocked = (command: "entity.remove" | "entity.drop_to_floor"): void => {
    const indices = withoutLocked(parts, selection.indices);
    if (indices.length > 0) void parts.server.command(command, { indices });
  };
  return [
    { id: "edit.undo", needs: "edit", label: t("Undo"), group: t("Edit"), keys: ["Ctrl+Z"], icon: "undo", possible: () => document.undo !== null, run: () => void parts.server.command("edit.undo", {}) },
    { id: "edit.redo", needs: "edit", label: t("Redo"), group: t("Edit"), keys: ["Ctrl+Shift+Z", "Ctrl+Y"], icon: "redo", possible: () => document.redo !== null, run: () => void parts.server.command("edit.redo", {}) },
    { id: "edit.delete", needs: "edit", label: t("Delete"), group: t("Edit"), keys: ["Delete", "Backspace"], icon: "bin", possible: some, run: () => forUnlocked("entity.remove") },
    { id: "edit.duplicate", needs: "edit", label: t("Duplicate"), group: t("Edit"), keys: ["Ctrl+D"], possible: some, run: () => void duplicate(parts) },
    { id: "edit.select_all", label: t("Select all that is not locked"), group: t("Edit"), keys: ["Ctrl+A"], run: () => selection.set(unlocked(parts, document.entities.keys())) },
    { id: "edit.select_none", label: t("Select nothing"), group: t("Edit"), keys: ["Escape"], run: () => (selection.clear(), parts.picked.set(null)) },
    { id: "edit.lock", needs: "edit", label: t("Lock or unlock"), group: t("Edit"), keys: ["L"], icon: "lock", possible: some, on: () => allLocked(parts, selection.indices), run: () => toggleLock(parts, selection.indices) },
    { id: "catalog.history", label: t("History of catalogue changes…"), group: t("Models"), keys: [], icon: "history", run: open.history },
    { id: "edit.drop", needs: "edit", label: t("Drop to floor"), group: t("Edit"), keys: ["End"], possible: some, run: () => forUnlocked("entity.drop_to_floor") },
  ];
}

async function duplicate(parts: Pick<Parts, "server" | "selection" | "entities">): Promise<void> {
  const bounds = parts.entities.boundsOf(parts.selection.indices, performance.now());
  const aside = bounds.isEmpty() ? 0.5 : bounds.max.x - bounds.min.x + 0.05;
  const made = await parts.server.command("entity.duplicate", { indices: [...parts.selection.indices], offset: [aside, 0, 0] });
  if (made) parts.selection.set(made.indices);
}

function toolActions(parts: Pick<Parts, "preferences">, gizmo: Gizmo): UserAction[] {
  const { preferences } = parts;
  const tool = (name: Gizmo["tool"], label: string, key: string): UserAction => ({
    id: `tool.${name}`,
    label,
    group: t("Tools"),
    keys: [key],
    icon: name,
    on: () => gizmo.tool === name,
    run: () => gizmo.use(name),
  });
  return [
    tool("select", t("Select"), "Q"),
    tool("move", t("Move"), "W"),
    tool("rotate", t("Rotate"), "E"),
    tool("scale", t("Scale"), "R"),
    {
      id: "tool.space",
      label: t("Handles along the entity's own axes"),
      group: t("Tools"),
      keys: ["X"],
      icon: "local",
      on: () => gizmo.space === "local",
      run: () => gizmo.setSpace(gizmo.space === "local" ? "world" : "local"),
    },
    {
      id: "tool.snap",
      label: t("Snap to steps (hold Shift for the opposite)"),
      group: t("Tools"),
      keys: [],
      icon: "snap",
      on: () => preferences.get("snap"),
      run: () => preferences.set("snap", !preferences.get("snap")),
    },
  ];
}

function simulationActions(parts: Pick<Parts, "server" | "notices" | "document" | "playback" | "entities">): UserAction[] {
  const begun = () => parts.playback.simulation.state !== "stopped";
  return [
    {
      id: "simulation.play",
      needs: "run",
      label: t("Play or pause"),
      group: t("Simulation"),
      keys: ["Space"],
      icon: "play",
      on: () => parts.playback.playing,
      run: () => void parts.server.command(parts.playback.playing ? "simulation.pause" : "simulation.play", {}),
    },
    { id: "simulation.step", needs: "run", label: t("One step"), group: t("Simulation"), keys: ["."], icon: "step", repeats: true, run: () => void parts.server.command("simulation.step", { count: 1 }) },
    { id: "simulation.reset", needs: "run", label: t("Back to the start"), group: t("Simulation"), keys: ["Shift+Space", "Home"], icon: "reset", possible: begun, run: () => void parts.server.command("simulation.reset", {}) },
    { id: "simulation.keep", needs: "edit", label: t("Settle: the scene begins as things are now"), group: t("Simulation"), keys: ["K"], icon: "keep", possible: begun, run: () => void keepPoses(parts) },
  ];
}

export async function keepPoses(parts: Pick<Parts, "server" | "notices" | "document">): Promise<void> {
  if (!(await parts.server.command("simulation.keep", {}))) return;
  const hasForms = [...parts.document.entities.values()].some((entity) => entity.kept);
  parts.notices.tell({
    level: "info",
    text: t("The scene begins as things are now; undo takes that back"),
    ...(hasForms && { remedy: t("Folds, dents, heaps and puddles are kept, too; “Forget” among a thing's values makes it as modelled again.") }),
  });
}

function viewActions(parts: Pick<Parts, "preferences" | "document" | "selection" | "entities" | "view" | "framing">, open: Openers): UserAction[] {
  const { preferences, view } = parts;
  const flip = <Name extends "tint" | "fullTint" | "grid" | "collision">(name: Name) => preferences.set(name, !preferences.get(name));
  return [
    { id: "view.focus", label: t("Focus on the selection"), group: t("View"), keys: ["F"], run: () => focus(parts) },
    { id: "view.tint", label: t("Show what is active and what sleeps"), group: t("View"), keys: ["T"], icon: "tint", on: () => preferences.get("tint"), run: () => flip("tint") },
    { id: "view.fullTint", label: t("In full colour: red, green and gray all over"), group: t("View"), keys: [], on: () => preferences.get("fullTint"), run: () => flip("fullTint") },
    { id: "view.grid", label: t("Grid"), group: t("View"), keys: ["G"], on: () => preferences.get("grid"), run: () => flip("grid") },
    { id: "view.collision", label: t("Collision shapes of the selection"), group: t("View"), keys: ["C"], on: () => preferences.get("collision"), run: () => flip("collision") },
    {
      id: "view.theme",
      label: t("Light theme"),
      group: t("View"),
      keys: [],
      on: () => preferences.get("theme") === "light",
      run: () => preferences.set("theme", preferences.get("theme") === "light" ? "dark" : "light"),
    },
    {
      id: "view.quality",
      label: t("Fast drawing (no shadows or reflections)"),
      group: t("View"),
      keys: [],
      on: () => preferences.get("quality") === "low",
      run: () => preferences.set("quality", preferences.get("quality") === "low" ? "high" : "low"),
    },
    { id: "view.screenshot", label: t("Save a picture"), group: t("View"), keys: [], icon: "camera", run: () => view.savePicture(parts.document.title) },
    { id: "view.search", label: t("Search models"), group: t("View"), keys: ["/", "Ctrl+F"], run: open.search },
    { id: "view.palette", label: t("All commands…"), group: t("View"), keys: ["Ctrl+K"], icon: "palette", run: open.palette },
    { id: "view.help", label: t("Help and keys"), group: t("View"), keys: ["?", "F1"], icon: "help", run: open.help },
  ];
}

/** Looks at the selection; without one at the scene, but for its floor and walls. */
function focus({ selection, entities, view, framing }: Pick<Parts, "selection" | "entities" | "view" | "framing">): void {
  const now = performance.now();
  if (selection.indices.length > 0) view.rig.focus(entities.boundsOf(selection.indices, now), now);
  else framing.show(false);
}
