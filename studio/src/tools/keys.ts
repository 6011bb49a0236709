// SPDX-License-Identifier: MIT
import type { Parts } from "../parts";
import type { UserAction } from "./actions";
import type { Pointer } from "./pointer";

/** The name of a key here and in scene files: "Ctrl+Shift+Z", "Space", ".", "W". */
export function keyName(event: KeyboardEvent): string {
  const key = event.key === " " ? "Space" : event.key.length === 1 ? event.key.toUpperCase() : event.key;
  const letter = /^[A-Z]$/.test(key) || key.length > 1;
  const modifiers = [event.ctrlKey || event.metaKey ? "Ctrl+" : "", event.altKey ? "Alt+" : "", event.shiftKey && letter ? "Shift+" : ""];
  return modifiers.join("") + key;
}

/** The keys of an action: the user's choice, or the action's own. */
export function keysOf(parts: Pick<Parts, "preferences">, action: UserAction): string[] {
  const chosen = parts.preferences.get("keys")[action.id];
  return chosen ? [chosen] : action.keys;
}

/** Runs actions by keys. */
export class Keyboard {
  constructor(
    private readonly parts: Pick<Parts, "preferences" | "server" | "document" | "playback">,
    private readonly actions: readonly UserAction[],
    private readonly pointer: Pointer,
  ) {
    addEventListener("keydown", (event) => this.press(event));
  }

  private press(event: KeyboardEvent): void {
    if (event.defaultPrevented || this.pointer.flying || isTyping(event) || document.querySelector("dialog[open]")) return;
    const name = keyName(event);
    if (this.triggerSceneAction(name, event)) return;
    const action = this.actions.find((each) => keysOf(this.parts, each).includes(name));
    if (!action || action.native || (event.repeat && !action.repeats)) return;
    // Space and Enter press a button that has the focus.
    if ((name === "Space" || name === "Enter") && event.target instanceof HTMLButtonElement) return;
    event.preventDefault();
    if (action.possible?.() ?? true) action.run();
  }

  /** While the scene plays, the keys of its actions come first. */
  private triggerSceneAction(name: string, event: KeyboardEvent): boolean {
    if (!this.parts.playback.playing || event.repeat) return false;
    const known = [...this.parts.document.actions.values()].map(({ trigger }) => (trigger.type === "signal" ? trigger.key : undefined)).find((key) => key?.toUpperCase() === name.toUpperCase());
    if (!known) return false;
    event.preventDefault();
    void this.parts.server.command("action.trigger", { key: known });
    return true;
  }
}

function isTyping(event: KeyboardEvent): boolean {
  const target = event.target as HTMLElement;
  if (target instanceof HTMLInputElement) return target.type !== "checkbox" && target.type !== "color";
  return target instanceof HTMLTextAreaElement || target instanceof HTMLSelectElement;
}
