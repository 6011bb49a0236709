// SPDX-License-Identifier: MIT
import type { DebugName } from "./connection/debug_frame";
import { Signal } from "./signal";
import type { Theme } from "./view/environment";
import { drawsInSoftware } from "./view/software";
import type { Quality } from "./view/tint";
import { VR_DEFAULTS, type VrSettings } from "./vr/settings";

/** This user's preferences; kept in the browser. */
export interface PreferenceValues {
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
  /** Impacts are heard. */
  sounds: boolean;
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
  snap: false,
  snapLength: 0.1,
  snapAngle: 15,
  favourites: [],
  recent: [],
  userName: "",
  nameAsked: false,
  recoveriesKnown: [],
  keys: {},
  sounds: true,
  vr: VR_DEFAULTS,
};

export class Preferences {
  readonly changed = new Signal<keyof PreferenceValues>();
  private readonly values: PreferenceValues;

  constructor() {
    const kept = readKept();
    this.values = { ...DEFAULTS, ...kept, vr: { ...VR_DEFAULTS, ...kept.vr } };
    if (!kept.quality && drawsInSoftware()) this.values.quality = "low";
    // `?quality=low` holds for one visit: for software renderers and tests.
    const asked = new URLSearchParams(location.search).get("quality");
    if (asked === "low" || asked === "high") this.values.quality = asked;
  }

  get<Name extends keyof PreferenceValues>(name: Name): PreferenceValues[Name] {
    return this.values[name];
  }

  set<Name extends keyof PreferenceValues>(name: Name, value: PreferenceValues[Name]): void {
    this.values[name] = value;
    try {
      localStorage.setItem(PLACE, JSON.stringify(this.values));
    } catch {
      // Where the user lets the browser store nothing, preferences are lost with the page.
    }
    this.changed.emit(name);
  }
}

function readKept(): Partial<PreferenceValues> {
  try {
    return JSON.parse(localStorage.getItem(PLACE) ?? "{}") as Partial<PreferenceValues>;
  } catch {
    return {};
  }
}
