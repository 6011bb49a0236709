// SPDX-License-Identifier: MIT
import type { DebugName } from "./connection/debug_frame";
import { Signal } from "./signal";
import type { Theme } from "./view/environment";
import { drawsInSoftware } from "./view/software";
import type { Quality } from "./view/tint";

/** What this browser's user likes; kept in the browser. */
export interface PreferenceValues {
  theme: Theme;
  quality: Quality;
  /** States of the simulation can be told from the picture. */
  tint: boolean;
  /** By their colour all over, in place of the things' own. */
  fullTint: boolean;
  grid: boolean;
  /** What collides is drawn over what is selected. */
  collision: boolean;
  /** What the solver sees is drawn over everything. */
  debug: readonly DebugName[];
  snap: boolean;
  /** Metres and degrees. */
  snapLength: number;
  snapAngle: number;
  favourites: string[];
  recent: string[];
  /** What the history of changes calls this browser's user; empty: a number. */
  userName: string;
  /** Keys the user chose for actions, by the action's id. */
  keys: Record<string, string>;
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
  keys: {},
};

export class Preferences {
  readonly changed = new Signal<keyof PreferenceValues>();
  private readonly values: PreferenceValues;

  constructor() {
    const kept = readKept();
    this.values = { ...DEFAULTS, ...kept };
    if (!kept.quality && drawsInSoftware()) this.values.quality = "low";
    // `?quality=low` for one visit: software renderers and tests.
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
      // A browser that keeps nothing forgets preferences; that is its user's wish.
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
