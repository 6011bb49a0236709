// SPDX-License-Identifier: MIT
import type { DebugName } from "./connection/debug_frame";
import { Signal } from "./signal";
import type { Theme } from "./view/environment";
import { drawsInSoftware } from "./view/software";
import type { Quality } from "./view/tint";
import { VR_DEFAULTS, type VrSettings } from "./vr/settings";

/** This user's preferences; kept in the browser. */
export interface PreferenceValues {
  /** Unless the user has chosen one, what the system asks for. */
  theme: Theme;
  quality: Quality;
  /** States of the simulation are shown by colours. */
  tint: boolean;
  /** The state's colour replaces the entity's own colour. */
  fullTint: boolean;
  grid: boolean;
  /** Collision shapes are drawn over the selection. */
  collision: boolean;
  /** Debug drawings of the solver that are shown over the picture. */
  debug: readonly DebugName[];
  /** Debug drawings of what is selected. */
  overlays: readonly DebugName[];
  /** Groups of the panels that the user opened or folded. */
  folds: Record<string, boolean>;
  /** How strongly the mouse pulls, N. */
  pull: number;
  snap: boolean;
  /** Metres and degrees. */
  snapLength: number;
  snapAngle: number;
  favourites: string[];
  recent: string[];
  /** This user's name in the history of changes; empty: a number. */
  userName: string;
  /** The user was asked for a name when somebody else came. */
  nameAsked: boolean;
  /** Recovered scenes that the user knows of, by name: they are not offered again. */
  recoveriesKnown: string[];
  /** Keys the user chose for actions, by the action's id. */
  keys: Record<string, string>;
  /** The first steps were shown. */
  toured: boolean;
  /** Panels that are put away. */
  folded: readonly ("left" | "right")[];
  /** Impacts are heard. */
  sounds: boolean;
  /** Only the row of buttons of the timeline is shown. */
  timelineFolded: boolean;
  /** Curves of the selection are shown under the timeline. */
  plots: boolean;
  vr: VrSettings;
}

const PLACE = "embody.preferences";
const DEFAULTS: PreferenceValues = {
  theme: "dark",
  quality: "high",
  tint: true,
  fullTint: false,
  grid: true,
  collision: false,
  debug: [],
  overlays: [],
  folds: {},
  pull: 400,
  snap: false,
  snapLength: 0.1,
  snapAngle: 15,
  favourites: [],
  recent: [],
  userName: "",
  nameAsked: false,
  recoveriesKnown: [],
  keys: {},
  toured: false,
  folded: [],
  sounds: true,
  timelineFolded: false,
  plots: false,
  vr: VR_DEFAULTS,
};

const LIGHT = matchMedia("(prefers-color-scheme: light)");
const CALM = matchMedia("(prefers-reduced-motion: reduce)");

function systemTheme(): Theme {
  return LIGHT.matches ? "light" : "dark";
}

/** The user asked the system for less motion: what glides jumps. */
export function wantsCalm(): boolean {
  return CALM.matches;
}

export class Preferences {
  readonly changed = new Signal<keyof PreferenceValues>();
  private readonly values: PreferenceValues;
  /** What the user has chosen; the rest may change with the system or with another version. */
  private readonly chosen: Partial<PreferenceValues>;

  constructor() {
    this.chosen = readKept();
    this.values = { ...DEFAULTS, ...this.chosen, vr: { ...VR_DEFAULTS, ...this.chosen.vr } };
    if (!this.chosen.quality && drawsInSoftware()) this.values.quality = "low";
    this.followSystem();
    // `?quality=low` holds for one visit: for software renderers and tests.
    const asked = new URLSearchParams(location.search).get("quality");
    if (asked === "low" || asked === "high") this.values.quality = asked;
  }

  get<Name extends keyof PreferenceValues>(name: Name): PreferenceValues[Name] {
    return this.values[name];
  }

  set<Name extends keyof PreferenceValues>(name: Name, value: PreferenceValues[Name]): void {
    this.values[name] = value;
    this.chosen[name] = value;
    this.keep();
    this.changed.emit(name);
  }

  /** Whether the theme is the system's. */
  get followsSystem(): boolean {
    return this.chosen.theme === undefined;
  }

  /** Takes the theme that the system asks for, now and whenever it changes. */
  useSystemTheme(): void {
    delete this.chosen.theme;
    this.keep();
    this.values.theme = systemTheme();
    this.changed.emit("theme");
  }

  private followSystem(): void {
    if (this.followsSystem) this.values.theme = systemTheme();
    LIGHT.addEventListener("change", () => {
      if (!this.followsSystem) return;
      this.values.theme = systemTheme();
      this.changed.emit("theme");
    });
  }

  private keep(): void {
    try {
      localStorage.setItem(PLACE, JSON.stringify(this.chosen));
    } catch {
      // Where the user lets the browser store nothing, preferences are lost with the page.
    }
  }
}

function readKept(): Partial<PreferenceValues> {
  try {
    return JSON.parse(localStorage.getItem(PLACE) ?? "{}") as Partial<PreferenceValues>;
  } catch {
    return {};
  }
}
