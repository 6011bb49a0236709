// SPDX-License-Identifier: MIT
import { t } from "../language";

/** What this browser and this address can show in a headset. */
export interface Offer {
  vr: boolean;
  ar: boolean;
  /** Why there is no VR, and what to do; empty where there is. */
  why: string;
  remedy: string;
  /** The reason is worth a message on the page: somebody came here with another device. */
  isNeeded: boolean;
}

/** Asks the browser what it has. */
export async function findOffer(): Promise<Offer> {
  const none = { vr: false, ar: false };
  if (!isSecureContext)
    return {
      ...none,
      why: t("Headsets need https"),
      remedy: t("Start “embody serve --tls --address 0.0.0.0” and open the address that it prints."),
      isNeeded: true,
    };
  const supports = async (mode: XRSessionMode): Promise<boolean> => (await navigator.xr?.isSessionSupported(mode).catch(() => false)) ?? false;
  const [vr, ar] = await Promise.all([supports("immersive-vr"), supports("immersive-ar")]);
  if (vr || ar) return { vr, ar, why: "", remedy: "", isNeeded: false };
  return {
    ...none,
    why: t("No headset found"),
    remedy: t("Open this page in the headset's own browser, or connect a headset to this computer and reload."),
    isNeeded: false,
  };
}
