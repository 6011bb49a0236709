// SPDX-License-Identifier: MIT
import { Color, Group, PointLight, SRGBColorSpace, Vector3 } from "three";
import type { SceneDocument } from "../document/scene_document";
import type { Light } from "../connection/scene_types";
import type { EntityView } from "./entity_view";
import type { Quality } from "./tint";

/** So many lamps light the scene at once: those that give most light where the user looks. Each costs time at every pixel. */
const MOST: Record<Quality, number> = { low: 3, high: 6 };
/** The picture's brightness of a candela at a metre: an exposure for rooms. */
const EXPOSURE = 0.08;
/** Eyes take the light of a room for nearly white: so much of a lamp's hue is left. */
const HUE_LEFT = 0.6;
const WHITE = new Color(1, 1, 1);
/** The light comes from this part of a lamp's height, and goes so far, m. */
const BULB = 0.75;
const REACH = 12;

/** The lights of lamps that are switched on. */
export class Lamps {
  readonly group = new Group();
  private pool: PointLight[] = [];
  private quality: Quality = "low";
  private lit: { index: number; light: Light }[] = [];
  private readonly place = new Vector3();

  constructor(
    private readonly document: SceneDocument,
    private readonly entities: EntityView,
  ) {}

  /** Lamps that are on, in the document's order. */
  get on(): readonly number[] {
    return this.lit.map(({ index }) => index);
  }

  /** Lamps that light the present picture. */
  get shining(): number {
    return this.pool.filter(({ intensity }) => intensity > 0).length;
  }

  setQuality(quality: Quality): void {
    this.quality = quality;
    this.reserve();
  }

  /** Lamps were switched, added or removed. */
  take(): void {
    this.lit = [...this.document.entities.values(), ...this.document.spawned.values()].flatMap(({ index, light, enabled }) => (isOn(light) && enabled !== false ? [{ index, light }] : []));
    this.reserve();
  }

  /** Puts the lights where the lamps are now. */
  update(now: number, target: Vector3): void {
    if (this.pool.length === 0) return;
    const ranked = this.lit
      .flatMap(({ index, light }) => {
        const bounds = this.entities.boundsOf([index], now);
        if (bounds.isEmpty() || this.document.absent.has(index)) return [];
        bounds.getCenter(this.place).setY(bounds.min.y + BULB * (bounds.max.y - bounds.min.y));
        return [{ light, place: this.place.clone(), weight: light.lumen / (1 + this.place.distanceToSquared(target)) }];
      })
      .sort((a, b) => b.weight - a.weight);
    this.pool.forEach((lamp, at) => {
      const chosen = ranked[at];
      lamp.intensity = chosen ? (EXPOSURE * chosen.light.lumen) / (4 * Math.PI) : 0;
      if (!chosen) return;
      lamp.position.copy(chosen.place);
      lamp.color.lerpColors(WHITE, colorOfKelvin(chosen.light.kelvin), HUE_LEFT);
    });
  }

  /** Shaders are made for a number of lights, so that this changes only between none and all. */
  private reserve(): void {
    const wanted = this.lit.length === 0 ? 0 : MOST[this.quality];
    if (this.pool.length === wanted) return;
    this.group.clear();
    for (const lamp of this.pool) lamp.dispose();
    this.pool = Array.from({ length: wanted }, () => new PointLight(0xffffff, 0, REACH, 2));
    if (wanted > 0) this.group.add(...this.pool);
  }
}

export function isOn(light: Light | undefined): light is Light {
  return light !== undefined && light.on && light.lumen > 0;
}

/** The colour of a black body, without its brightness (Tanner Helland's fit of Charity's table, within a few per cent of 1000 to 20000 K). */
export function colorOfKelvin(kelvin: number): Color {
  const t = kelvin / 100;
  const red = t <= 66 ? 255 : 329.698727446 * (t - 60) ** -0.1332047592;
  const green = t <= 66 ? 99.4708025861 * Math.log(t) - 161.1195681661 : 288.1221695283 * (t - 60) ** -0.0755148492;
  const blue = t >= 66 ? 255 : t <= 19 ? 0 : 138.5177312231 * Math.log(t - 10) - 305.0447927307;
  const part = (value: number) => Math.min(1, Math.max(0, value / 255));
  return new Color().setRGB(part(red), part(green), part(blue), SRGBColorSpace);
}
