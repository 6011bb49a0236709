// SPDX-License-Identifier: MIT
import { VRButton } from "three/examples/jsm/webxr/VRButton.js";
import type { View } from "./view";

/** A button that shows the scene in a headset, where the browser has one. */
export async function offerHeadset(view: View, place: HTMLElement): Promise<void> {
  const supported = (await navigator.xr?.isSessionSupported("immersive-vr").catch(() => false)) ?? false;
  if (!supported) return;
  view.renderer.xr.enabled = true;
  view.renderer.xr.addEventListener("sessionstart", () => view.drawForHeadset());
  view.renderer.xr.addEventListener("sessionend", () => view.endHeadset());
  const button = VRButton.createButton(view.renderer);
  button.classList.add("headset-button");
  place.append(button);
}
