// SPDX-License-Identifier: MIT
import type { Parts } from "../parts";
import { icon } from "../tools/icons";
import { findOffer, type Offer } from "../vr/offer";
import type { VrSession } from "../vr/session";
import { element, show } from "./element";
import { t } from "../language";

/** Buttons that show the scene in a headset; where that is not possible, why and what to do. */
export class HeadsetButtons {
  readonly root = element("div", { class: "headset-buttons", role: "group", "aria-label": t("Headset") });
  /** What was found, for the view options. */
  offer: Offer | null = null;

  constructor(
    private readonly parts: Pick<Parts, "preferences">,
    private readonly session: VrSession,
  ) {
    void this.fill();
    session.changed.on(() => show(this.root, !session.isRunning));
    parts.preferences.changed.on((name) => name === "vr" && this.refresh());
  }

  private async fill(): Promise<void> {
    this.offer = await findOffer();
    this.refresh();
  }

  private refresh(): void {
    const { offer, session } = this;
    if (!offer) return;
    if (offer.vr || offer.ar) {
      this.root.replaceChildren(
        ...(offer.vr ? [this.button("enter-vr", t("Enter VR"), () => void session.enter("immersive-vr")), this.scaleButton()] : []),
        ...(offer.ar ? [this.button("enter-ar", t("Enter AR"), () => void session.enter("immersive-ar"))] : []),
      );
    } else if (offer.isNeeded) {
      this.root.replaceChildren(element("p", { class: "headset-why", role: "note", "data-testid": "vr-why" }, icon("headset"), element("span", {}, element("strong", {}, `${offer.why}. `), offer.remedy)));
    } else this.root.replaceChildren();
  }

  private button(id: string, text: string, run: () => void): HTMLElement {
    return element("button", { class: "headset-button", "data-testid": id, onclick: run }, icon("headset"), text);
  }

  /** How large the scene is at the start. */
  private scaleButton(): HTMLElement {
    const { preferences } = this.parts;
    const small = preferences.get("vr").dollhouse;
    return element(
      "button",
      {
        class: "headset-button headset-scale",
        "data-testid": "vr-scale",
        "aria-pressed": String(small),
        title: small ? t("Begins with the scene on a table, 1 : 10. Click for life-size.") : t("Begins life-size. Click for the scene on a table, 1 : 10."),
        onclick: () => preferences.set("vr", { ...preferences.get("vr"), dollhouse: !small }),
      },
      small ? "1 : 10" : "1 : 1",
    );
  }
}
