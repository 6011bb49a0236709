// SPDX-License-Identifier: MIT
import { Vector3 } from "three";
import type { Axis } from "../connection/messages";
import type { Vector } from "../connection/scene_types";
import { outermostGroup } from "../document/groups";
import type { Parts } from "../parts";
import type { UserAction } from "./actions";
import type { IconName } from "./icons";
import { withoutLocked } from "./locks";
import { t } from "../language";

/** One press of an arrow key, m, where no steps are set. */
const NUDGE = 0.01;
const TURN = Math.PI / 12;
/** Presses of a key and notches of a wheel that follow each other within this time are one step of undo, ms. */
const ONE_STEP = 800;

type ArrangeParts = Pick<Parts, "preferences" | "server" | "notices" | "document" | "selection" | "view">;

/** The same key for edits in a row, so that undo takes them back together. */
class MergeKeys {
  private key = "";
  private last = 0;
  private count = 0;

  next(what: string): string {
    const now = performance.now();
    if (now - this.last > ONE_STEP || !this.key.startsWith(what)) this.key = `${what}-${Date.now()}-${this.count++}`;
    this.last = now;
    return this.key;
  }
}
const merges = new MergeKeys();

/** Moves, turns, aligns and groups what is selected. */
export function arrangeActions(parts: ArrangeParts): UserAction[] {
  const { selection } = parts;
  const some = () => selection.indices.length > 0;
  const atLeast = (count: number) => () => selection.indices.length >= count;
  const indices = () => [...selection.indices];
  // Locked things stay; the others are arranged where there are enough of them.
  const arrange = (least: number, run: (indices: number[]) => void): void => {
    const free = withoutLocked(parts, selection.indices);
    if (free.length >= least) run(free);
  };
  const nudge = (key: string, label: string, right: number, up: number, away: number): UserAction[] =>
    [1, 10].map((times) => ({
      id: `arrange.nudge.${key}.${times}`,
      label: times === 1 ? t("Nudge {{direction}}", { direction: label }) : t("Nudge {{direction}}, ten times as far", { direction: label }),
      group: t("Arrange"),
      keys: [times === 1 ? key : `Shift+${key}`],
      possible: some,
      repeats: true,
      run: () => void nudgeBy(parts, right * times, up * times, away * times),
    }));
  const align = (axis: Axis, at: "low" | "center" | "high", label: string, icon?: IconName): UserAction => ({
    ...(icon && { icon }),
    id: `arrange.align.${axis}.${at}`,
    label: t("Align {{place}}", { place: label }),
    group: t("Arrange"),
    keys: [],
    possible: atLeast(2),
    run: () => arrange(2, (free) => void parts.server.command("entity.align", { indices: free, axis, at })),
  });
  const along = (verb: string, id: string, least: number, run: (axis: Axis) => void, icons: Partial<Record<Axis, IconName>>): UserAction[] =>
    (["x", "y", "z"] as const).map((axis) => ({ ...(icons[axis] && { icon: icons[axis] }), id: `arrange.${id}.${axis}`, label: t("{{what}} {{axis}}", { what: verb, axis: axis.toUpperCase() }), group: t("Arrange"), keys: [], possible: atLeast(least), run: () => run(axis) }));
  const actions: UserAction[] = [
    ...nudge("ArrowLeft", t("to the left"), -1, 0, 0),
    ...nudge("ArrowRight", t("to the right"), 1, 0, 0),
    ...nudge("ArrowUp", t("away"), 0, 0, 1),
    ...nudge("ArrowDown", t("nearer"), 0, 0, -1),
    ...nudge("PageUp", t("up"), 0, 1, 0),
    ...nudge("PageDown", t("down"), 0, -1, 0),
    { id: "arrange.turn.left", label: t("Turn by 15° to the left"), group: t("Arrange"), keys: ["["], possible: some, repeats: true, run: () => turn(parts, TURN) },
    { id: "arrange.turn.right", label: t("Turn by 15° to the right"), group: t("Arrange"), keys: ["]"], possible: some, repeats: true, run: () => turn(parts, -TURN) },
    align("x", "low", t("at the lowest X"), "alignLeft"),
    align("x", "center", t("the middles along X"), "alignMiddle"),
    align("x", "high", t("at the highest X"), "alignRight"),
    align("y", "low", t("the bases"), "alignBase"),
    align("y", "center", t("the middles in height")),
    align("y", "high", t("the tops"), "alignTop"),
    align("z", "low", t("at the lowest Z"), "alignFar"),
    align("z", "center", t("the middles along Z"), "alignBetween"),
    align("z", "high", t("at the highest Z"), "alignNear"),
    ...along(t("Equal gaps along"), "distribute", 3, (axis) => arrange(3, (free) => void parts.server.command("entity.distribute", { indices: free, axis })), { x: "gapsAcross", z: "gapsAlong" }),
    ...along(t("Mirror along"), "mirror", 1, (axis) => arrange(1, (free) => void parts.server.command("entity.mirror", { indices: free, axis })), { x: "mirrorAcross", z: "mirrorAlong" }),
    ...(["x", "y", "z"] as const).map(
      (axis, at): UserAction => ({
        id: `arrange.array.${axis}`,
        label: t("Row of five along {{axis}}", { axis: axis.toUpperCase() }),
        group: t("Arrange"),
        keys: [],
        possible: some,
        run: () => void row(parts, at),
      }),
    ),
    { id: "arrange.group", label: t("Group"), group: t("Arrange"), icon: "group", keys: ["Ctrl+G"], possible: atLeast(2), run: () => void parts.server.command("entity.group", { indices: indices() }) },
    { id: "arrange.ungroup", label: t("Ungroup"), group: t("Arrange"), icon: "ungroup", keys: ["Ctrl+Shift+G"], possible: () => groupsOf(parts).length > 0, run: () => void ungroup(parts) },
  ];
  return actions.map((action) => ({ ...action, needs: "edit" }));
}

/** Four copies beside the selection, each touching the one before. */
async function row(parts: Pick<Parts, "server" | "selection">, axis: number): Promise<void> {
  const counts: Vector = [1, 1, 1];
  counts[axis] = 5;
  const made = await parts.server.command("entity.array", { indices: [...parts.selection.indices], counts });
  if (made) parts.selection.set([...parts.selection.indices, ...made.indices]);
}

function groupsOf(parts: Pick<Parts, "document" | "selection">): string[] {
  const groups = parts.selection.indices.map((index) => outermostGroup(parts.document.entity(index)?.group));
  return [...new Set(groups)].filter(Boolean);
}

async function ungroup(parts: Pick<Parts, "server" | "document" | "selection">): Promise<void> {
  for (const group of groupsOf(parts)) await parts.server.command("entity.ungroup", { group });
}

/** Along the axes of the world that are nearest to the viewer's right and forward. */
async function nudgeBy(parts: ArrangeParts, right: number, up: number, away: number): Promise<void> {
  const { preferences, selection, server, view } = parts;
  const forward = view.rig.camera.getWorldDirection(new Vector3()).setY(0);
  const alongX = Math.abs(forward.x) > Math.abs(forward.z);
  const ahead: Vector = alongX ? [Math.sign(forward.x), 0, 0] : [0, 0, Math.sign(forward.z) || -1];
  const aside: Vector = [-ahead[2], 0, ahead[0]];
  const step = preferences.get("snap") ? preferences.get("snapLength") : NUDGE;
  const offset = [0, 1, 2].map((axis) => step * (right * aside[axis]! + away * ahead[axis]! + (axis === 1 ? up : 0))) as Vector;
  const indices = withoutLocked(parts, selection.indices);
  if (indices.length > 0) await server.command("entity.move", { indices, offset, merge: merges.next("nudge") });
}

function turn(parts: Pick<Parts, "server" | "notices" | "document" | "selection">, angle: number): void {
  const indices = withoutLocked(parts, parts.selection.indices);
  if (indices.length > 0) void parts.server.command("entity.turn", { indices, angle, merge: merges.next("turn") });
}

/** A notch turns by 15°. */
export function turnByWheel(parts: Pick<Parts, "server" | "notices" | "document" | "selection">, notches: number): void {
  if (notches !== 0) turn(parts, -Math.sign(notches) * TURN);
}
