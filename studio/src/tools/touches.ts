// SPDX-License-Identifier: MIT
import type { CameraRig } from "../view/camera_rig";
import type { Pointer } from "./pointer";

/** A finger that stays this long where it was put down asks for the menu, ms; and moves less than this, px. */
const LONG_PRESS_MS = 550;
const STILL_REACH = 8;
/** The zoom of one notch of a wheel. */
const NOTCH = Math.log(1.12);

interface Finger {
  x: number;
  y: number;
}

/** Fingers on the picture: one does what the mouse does, two move and zoom the camera, one that rests opens the menu. */
export class Touches {
  private readonly fingers = new Map<number, Finger>();
  private resting = 0;

  constructor(
    private readonly canvas: HTMLElement,
    private readonly rig: CameraRig,
    private readonly pointer: Pick<Pointer, "cancel" | "openMenuAt">,
  ) {
    const listen = (name: "pointerdown" | "pointermove" | "pointerup" | "pointercancel", take: (event: PointerEvent) => void) =>
      canvas.addEventListener(name, (event) => event.pointerType === "touch" && take(event));
    listen("pointerdown", (event) => this.put(event));
    listen("pointermove", (event) => this.move(event));
    listen("pointerup", (event) => this.lift(event));
    listen("pointercancel", (event) => this.lift(event));
  }

  private put(event: PointerEvent): void {
    const at = { x: event.clientX, y: event.clientY };
    this.fingers.set(event.pointerId, at);
    clearTimeout(this.resting);
    if (this.fingers.size > 1) this.pointer.cancel();
    else
      this.resting = window.setTimeout(() => {
        this.pointer.cancel();
        this.pointer.openMenuAt(at.x, at.y);
      }, LONG_PRESS_MS);
  }

  private move(event: PointerEvent): void {
    const finger = this.fingers.get(event.pointerId);
    if (!finger) return;
    if (this.fingers.size !== 2) {
      if (Math.hypot(event.clientX - finger.x, event.clientY - finger.y) > STILL_REACH) clearTimeout(this.resting);
      return;
    }
    const before = this.span();
    [finger.x, finger.y] = [event.clientX, event.clientY];
    const after = this.span();
    // The middle of the fingers stays over the same place, their distance is the zoom.
    this.rig.pan(after.x - before.x, after.y - before.y, this.canvas.clientHeight);
    if (before.length > 0 && after.length > 0) this.rig.zoom(Math.log(before.length / after.length) / NOTCH);
  }

  private lift(event: PointerEvent): void {
    clearTimeout(this.resting);
    this.fingers.delete(event.pointerId);
  }

  private span(): { x: number; y: number; length: number } {
    const [a, b] = [...this.fingers.values()] as [Finger, Finger];
    return { x: (a.x + b.x) / 2, y: (a.y + b.y) / 2, length: Math.hypot(a.x - b.x, a.y - b.y) };
  }
}
