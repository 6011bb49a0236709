// SPDX-License-Identifier: MIT
import type { Parts } from "../parts";
import { element, setText, show } from "./element";
import { FILTERING, refold } from "./folding";
import { searchedText, t } from "../language";

/** Words that people use for values, beside their labels. */
const SYNONYMS: Record<string, string> = {
  kind: "type rigid soft static cloth rope liquid movable fixed",
  category: "what it is type",
  surface_material: "made of stuff wood steel rubber",
  mass: "weight heavy light kilogram",
  density: "heavy weight specific gravity",
  inertia: "turning rotation spin moment",
  center_of_mass: "balance balance point centre of gravity tips over",
  friction_static: "slippery grip rough sticky slide",
  friction_dynamic: "slippery grip rough slide skid",
  friction_rolling: "roll wheel",
  friction_torsional: "spin top",
  restitution: "bounce bouncy elastic rebound jump",
  restitution_threshold: "bounce",
  linear_damping: "drag slow air resistance",
  angular_damping: "spin drag slow",
  gravity_factor: "weightless float fall rise",
  kinematic: "animated moving platform",
  collision_mask: "ghost pass through layer filter",
  collision_group: "layer filter",
  collision_shape: "hull collider",
  break_impulse: "fragile break",
  break_energy: "fragile break",
  breaks: "fragile break",
  youngs_modulus: "stiffness hard squishy elastic",
  poisson_ratio: "squeeze bulge",
  damping_rayleigh: "jelly wobble",
  yield_stress: "plastic dent permanent",
  stretch_stiffness: "elastic stretch stiffness",
  bend_stiffness: "fold drape stiffness",
  bend_friction: "fold crease swing hysteresis internal friction",
  bend_yield: "fold crease plastic dent crumple paper foil",
  inflation: "inflate blow up gas air pressure balloon",
  dynamic_viscosity: "thick runny sticky syrup",
  friction_angle: "heap slope",
  slack: "loose long",
  gravity: "weight fall earth moon mars",
  wind: "air breeze storm",
};

const HAN = /\p{Script=Han}/u;

/** Finds values by what people call them, and shows only what was changed: in all groups of a panel. */
export class ValueSearch {
  readonly root: HTMLElement;
  private readonly words = element("input", { type: "search", placeholder: t("Find a value"), "aria-label": t("Find a value"), "data-testid": "value-search", oninput: () => this.apply() });
  private readonly changedOnly = element("button", { class: "chip", "aria-pressed": "false", title: t("Show only values that were set here by hand"), "data-testid": "only-changed", onclick: () => this.flip() }, t("Only what I changed"));
  private readonly nothing = element("p", { class: "note", "data-testid": "no-value" });
  private isFiltering = false;
  private wanted = 0;

  constructor(
    private readonly parts: Pick<Parts, "preferences">,
    private readonly panel: HTMLElement,
  ) {
    this.root = element("div", { class: "value-search" }, this.words, this.changedOnly, this.nothing);
    show(this.nothing, false);
    this.words.addEventListener("keydown", (event) => {
      if (event.key !== "Escape" || this.words.value === "") return;
      event.stopPropagation();
      this.words.value = "";
      this.apply();
    });
    // Panels make their rows anew when something else is selected.
    new MutationObserver(() => this.applySoon()).observe(panel, { childList: true, subtree: true, attributes: true, attributeFilter: ["data-changed"] });
  }

  private flip(): void {
    const pressed = this.changedOnly.getAttribute("aria-pressed") !== "true";
    this.changedOnly.setAttribute("aria-pressed", String(pressed));
    this.apply();
  }

  private applySoon(): void {
    if (!this.isFiltering || this.wanted) return;
    this.wanted = requestAnimationFrame(() => {
      this.wanted = 0;
      this.apply();
    });
  }

  private apply(): void {
    const words = this.words.value.trim().toLowerCase().split(/\s+/).filter(Boolean);
    const changedOnly = this.changedOnly.getAttribute("aria-pressed") === "true";
    const wasFiltering = this.isFiltering;
    this.isFiltering = words.length > 0 || changedOnly;
    if (!this.isFiltering && !wasFiltering) return;
    this.panel.classList.toggle(FILTERING, this.isFiltering);
    let found = 0;
    for (const row of this.panel.querySelectorAll<HTMLElement>(".attribute")) {
      const fits = (words.length === 0 || matches(row, words)) && (!changedOnly || row.dataset["changed"] === "true");
      row.classList.toggle("filtered", this.isFiltering && !fits);
      if (fits && row.offsetParent !== null) ++found;
    }
    for (const group of this.panel.querySelectorAll<HTMLDetailsElement>("details.group")) {
      const some = group.querySelector(".attribute:not(.filtered)") !== null;
      group.classList.toggle("filtered", this.isFiltering && !some);
      if (this.isFiltering) group.open = some;
      else refold(this.parts.preferences, group);
      if (this.isFiltering && some) ++found;
    }
    setText(this.nothing, words.length > 0 ? t("No value is called “{{words}}”.", { words: this.words.value.trim() }) : t("Nothing was changed by hand here."));
    show(this.nothing, this.isFiltering && found === 0);
  }
}

/** Whether each word begins a word of the row's label, unit, name or of what people call it, in English or in the user's language. */
function matches(row: HTMLElement, words: readonly string[]): boolean {
  const { name = "", label = "" } = row.dataset;
  const shown = row.querySelector(".attribute-label")?.textContent ?? "";
  const unit = row.querySelector(".unit")?.textContent ?? "";
  const text = ` ${shown} ${label} ${unit} ${name.replaceAll("_", " ")} ${searchedText(SYNONYMS[name] ?? "")}`.toLowerCase();
  // Chinese has no spaces between words.
  return words.every((word) => text.includes(HAN.test(word) ? word : ` ${word}`));
}
