// SPDX-License-Identifier: MIT
// A browser sends no click for what was replaced between press and release: what fills a list anew waits for the release.

let isPressed = false;
const waiting = new Set<() => void>();

function letGo(): void {
  isPressed = false;
  // The click comes right after the release.
  setTimeout(() => {
    if (isPressed) return;
    const runs = [...waiting];
    waiting.clear();
    for (const run of runs) run();
  });
}

addEventListener("pointerdown", () => (isPressed = true), { capture: true });
addEventListener("pointerup", letGo, { capture: true });
// A drag between lists ends the pointer's press at its begin, and itself where its source is replaced.
let isDragging = false;
addEventListener("dragstart", () => (isDragging = true), { capture: true });
addEventListener("pointercancel", () => isDragging || letGo(), { capture: true });
addEventListener("dragend", () => (isDragging = false, letGo()), { capture: true });
// The button was let go where this page hears nothing of it.
addEventListener("blur", letGo);
addEventListener("pointermove", (event) => isPressed && event.buttons === 0 && letGo(), { capture: true });

/** Does it now, or right after the click where a button of the mouse or a finger is down; there the same function waits only once. */
export function afterPress(run: () => void): void {
  if (isPressed) waiting.add(run);
  else run();
}
