// SPDX-License-Identifier: MIT
import { CanvasTexture, LinearFilter, type PerspectiveCamera, Sprite, SpriteMaterial, SRGBColorSpace } from "three";

/** Height of a tag and width of a dot on the screen, CSS pixels. */
const TAG_PIXELS = 20;
const DOT_PIXELS = 12;
/** The picture of a tag has so many times as many pixels, for sharp letters on fine screens. */
const FINENESS = 3;
const FONT = `600 ${12 * FINENESS}px system-ui, "DejaVu Sans", sans-serif`;
const LONGEST_NAME = 24;

/** A sprite that keeps its size on the screen, whatever its distance; `pixels` is its height. */
export interface ScreenSprite {
  sprite: Sprite;
  pixels: number;
  aspect: number;
}

/** A name on its member's colour; `lift` moves it up from its place, in its own heights. */
export function nameTag(name: string, color: string, lift: number): ScreenSprite {
  const text = name.length > LONGEST_NAME ? `${name.slice(0, LONGEST_NAME - 1)}…` : name;
  const canvas = document.createElement("canvas");
  const context = canvas.getContext("2d")!;
  canvas.height = TAG_PIXELS * FINENESS;
  context.font = FONT;
  canvas.width = Math.ceil(context.measureText(text).width) + canvas.height * 0.8;
  // A canvas of a new size has forgotten the font.
  context.font = FONT;
  context.fillStyle = color;
  context.beginPath();
  context.roundRect(0, 0, canvas.width, canvas.height, canvas.height / 2);
  context.fill();
  context.fillStyle = inkOn(color);
  context.textAlign = "center";
  context.textBaseline = "middle";
  context.fillText(text, canvas.width / 2, canvas.height * 0.53);
  const made = spriteOf(canvas);
  made.center.set(0.5, -lift);
  return { sprite: made, pixels: TAG_PIXELS, aspect: canvas.width / canvas.height };
}

/** A dot with a light rim, for the point under a member's mouse. */
export function pointerDot(color: string): ScreenSprite {
  const canvas = document.createElement("canvas");
  const size = (canvas.width = canvas.height = DOT_PIXELS * FINENESS);
  const context = canvas.getContext("2d")!;
  context.beginPath();
  context.arc(size / 2, size / 2, size / 2 - FINENESS, 0, 2 * Math.PI);
  context.fillStyle = color;
  context.fill();
  context.lineWidth = 1.5 * FINENESS;
  context.strokeStyle = "#ffffff";
  context.stroke();
  return { sprite: spriteOf(canvas), pixels: DOT_PIXELS, aspect: 1 };
}

/** Scales the sprite for a picture of so many CSS pixels in height. */
export function keepSize({ sprite, pixels, aspect }: ScreenSprite, camera: PerspectiveCamera, height: number): void {
  // A sprite without attenuation has its size at a distance of one metre.
  const size = (2 * Math.tan((camera.fov * Math.PI) / 360) * pixels) / Math.max(height, 1);
  sprite.scale.set(size * aspect, size, 1);
}

export function disposeSprite({ sprite }: ScreenSprite): void {
  sprite.material.map?.dispose();
  sprite.material.dispose();
}

/** Black or white, whichever is easier to read on the colour "#rrggbb". */
export function inkOn(color: string): string {
  // The relative luminance of WCAG 2.2, at which black and white have the same contrast.
  const [red, green, blue] = [1, 3, 5].map((at) => {
    const part = parseInt(color.slice(at, at + 2), 16) / 255;
    return part <= 0.04045 ? part / 12.92 : ((part + 0.055) / 1.055) ** 2.4;
  }) as [number, number, number];
  return 0.2126 * red + 0.7152 * green + 0.0722 * blue > 0.179 ? "#101418" : "#ffffff";
}

function spriteOf(canvas: HTMLCanvasElement): Sprite {
  const map = new CanvasTexture(canvas);
  map.colorSpace = SRGBColorSpace;
  map.minFilter = LinearFilter;
  map.generateMipmaps = false;
  const sprite = new Sprite(new SpriteMaterial({ map, sizeAttenuation: false, depthTest: false, depthWrite: false, toneMapped: false, fog: false }));
  sprite.renderOrder = 1000;
  sprite.raycast = () => {};
  return sprite;
}
