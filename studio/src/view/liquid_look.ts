// SPDX-License-Identifier: MIT
import type { AttributeEntry } from "../connection/messages";

/** Absorption and scattering of light by a liquid, 1/m: red, green and blue. */
export interface Optics {
  absorption: [number, number, number];
  scattering: number;
}

/** Optics of water, until the server has sent the liquid's own. */
export const WATER: Optics = { absorption: [0.34, 0.0565, 0.0092], scattering: 0.03 };

export function opticsOf(attributes: readonly AttributeEntry[]): Optics {
  const number = (name: string, standard: number): number => {
    const value = attributes.find((entry) => entry.name === name)?.value;
    return typeof value === "number" ? value : standard;
  };
  const [red, green, blue] = WATER.absorption;
  return {
    absorption: [number("absorption_red", red), number("absorption_green", green), number("absorption_blue", blue)],
    scattering: number("turbidity", WATER.scattering),
  };
}

/** Appearance of a layer of a liquid. */
export interface Look {
  /** Fraction of the light from behind that is transmitted. */
  through: [number, number, number];
  /** Fraction of the light from in front that is reflected. */
  back: [number, number, number];
}

/** Transmission and reflection of a layer of this thickness, m, by the theory of P. Kubelka and F. Munk (1931): K = 2 a, S = 3/4 s. */
export function lookOf({ absorption, scattering }: Optics, thickness: number): Look {
  const look: Look = { through: [1, 1, 1], back: [0, 0, 0] };
  const s = Math.max(0.75 * scattering, 1e-6);
  absorption.forEach((absorbed, channel) => {
    const k = 2 * absorbed;
    const a = 1 + k / s;
    const b = Math.sqrt(Math.max(a * a - 1, 1e-9));
    const x = Math.min(b * s * thickness, 50);
    const below = a * Math.sinh(x) + b * Math.cosh(x);
    look.through[channel] = b / below;
    look.back[channel] = Math.sinh(x) / below;
  });
  return look;
}
