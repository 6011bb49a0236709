// SPDX-License-Identifier: MIT
import type { Parts } from "../parts";
import type { UserAction } from "./actions";
import type { Pointer } from "./pointer";
import { dropAt } from "./surface_drag";
import { t } from "../language";

type ClipboardParts = Pick<Parts, "server" | "notices" | "selection" | "view">;

/** What was copied last here, for pages that may not use the system's clipboard (plain http from another machine). */
let lastCopied = "";

/** Copy, cut and paste as text of a scene: within a scene, between scenes and between browsers. */
export function clipboardActions(parts: ClipboardParts, pointer: Pick<Pointer, "last">): UserAction[] {
  const some = () => parts.selection.indices.length > 0;
  // On Ctrl+V the browser tells the text itself, and asks nobody for leave.
  addEventListener("paste", (event) => {
    const target = event.target as HTMLElement;
    if (target instanceof HTMLInputElement || target instanceof HTMLTextAreaElement || document.querySelector("dialog[open]")) return;
    const text = event.clipboardData?.getData("text/plain");
    event.preventDefault();
    void paste(parts, pointer, text || lastCopied);
  });
  return [
    { id: "edit.copy", label: t("Copy"), group: t("Edit"), keys: ["Ctrl+C"], possible: some, run: () => void copy(parts) },
    { id: "edit.cut", needs: "edit", label: t("Cut"), group: t("Edit"), keys: ["Ctrl+X"], possible: some, run: () => void cut(parts) },
    { id: "edit.paste", needs: "edit", label: t("Paste"), group: t("Edit"), keys: ["Ctrl+V"], native: true, run: () => void pasteByHand(parts, pointer) },
  ];
}

async function copy(parts: ClipboardParts): Promise<boolean> {
  const copied = await parts.server.command("entity.copy", { indices: [...parts.selection.indices] });
  if (!copied) return false;
  lastCopied = JSON.stringify(copied.part, null, 1);
  await navigator.clipboard?.writeText(lastCopied).catch(() =>
    parts.notices.tell({ level: "info", text: t("Copied for this page only"), remedy: t("The browser did not let the page use the system's clipboard.") }),
  );
  return true;
}

async function cut(parts: ClipboardParts): Promise<void> {
  const indices = [...parts.selection.indices];
  if (await copy(parts)) await parts.server.command("entity.remove", { indices });
}

/** Paste from a menu: the page has to ask for the clipboard's text. */
async function pasteByHand(parts: ClipboardParts, pointer: Pick<Pointer, "last">): Promise<void> {
  const text = await navigator.clipboard?.readText().catch(() => lastCopied);
  await paste(parts, pointer, text || lastCopied);
}

async function paste(parts: ClipboardParts, pointer: Pick<Pointer, "last">, text: string): Promise<void> {
  let part: unknown;
  try {
    part = JSON.parse(text);
  } catch {
    return parts.notices.tell({ level: "warning", text: text ? t("The clipboard holds no part of a scene") : t("Nothing was copied yet"), remedy: t("Select things and copy them with Ctrl+C.") });
  }
  const drop = pointer.last.over ? dropAt(parts, pointer.last.x, pointer.last.y) : undefined;
  const pasted = await parts.server.command("entity.paste", { part, ...(drop && { drop }) });
  if (pasted) parts.selection.set(pasted.indices);
}
