// SPDX-License-Identifier: MIT
import { CanvasTexture, LinearFilter, LinearMipmapLinearFilter, Mesh, MeshBasicMaterial, PlaneGeometry, SRGBColorSpace, Vector3 } from "three";
import { type Box, Painter, TEXT } from "./painter";
import type { Widget } from "./widgets";

/** Pixels of the canvas a millimetre: text of 13 mm has 26 pixels. */
const FINENESS = 2;
const CORNER = 12;
/** Height of the bar that a panel is carried by, mm. */
export const BAR = 30;

export interface PanelOptions {
  id: string;
  title: string;
  /** mm */
  width: number;
  height: number;
  /** Has a bar with the title and a button to close it. */
  hasBar?: boolean;
  /** Only to read: rays go through it. */
  isPassive?: boolean;
}

/** A flat panel in the user's room with widgets on it, drawn into a texture. It is painted again only when it changed. */
export class Panel {
  readonly mesh: Mesh<PlaneGeometry, MeshBasicMaterial>;
  readonly painter: Painter;
  /** What is on it; set by the panel's owner in `layOut`. */
  widgets: Widget[] = [];
  hovered: string | null = null;
  pressed: string | null = null;
  /** The user scrolls with the stick or pages with buttons: rows down. */
  scroll: ((rows: number) => void) | null = null;
  /** The user closes it. */
  onClose: (() => void) | null = null;
  private readonly texture: CanvasTexture;
  private isOld = true;
  private readonly corner = new Vector3();

  constructor(readonly options: PanelOptions) {
    const canvas = document.createElement("canvas");
    canvas.width = options.width * FINENESS;
    canvas.height = options.height * FINENESS;
    this.painter = new Painter(canvas.getContext("2d")!);
    this.texture = new CanvasTexture(canvas);
    this.texture.colorSpace = SRGBColorSpace;
    this.texture.minFilter = LinearMipmapLinearFilter;
    this.texture.magFilter = LinearFilter;
    this.texture.anisotropy = 8;
    const material = new MeshBasicMaterial({ map: this.texture, transparent: true, toneMapped: false, fog: false, side: 2, depthWrite: false });
    this.mesh = new Mesh(new PlaneGeometry(options.width / 1000, options.height / 1000), material);
    this.mesh.renderOrder = 1050;
    this.mesh.visible = false;
    this.mesh.frustumCulled = false;
  }

  get isShown(): boolean {
    return this.mesh.visible;
  }

  show(shown: boolean): void {
    this.mesh.visible = shown;
    if (shown) this.renew();
    else this.hovered = this.pressed = null;
  }

  /** Something on it changed. */
  renew(): void {
    this.isOld = true;
  }

  hover(id: string | null): void {
    if (this.hovered === id) return;
    this.hovered = id;
    this.renew();
  }

  /** The widget that can be pressed at a place, mm; between buttons the nearest within a finger's reach. */
  widgetAt(x: number, y: number): Widget | null {
    for (let at = this.widgets.length - 1; at >= 0; --at) {
      const widget = this.widgets[at]!;
      if (!widget.off && inBox(widget.box, x, y)) return widget;
    }
    return null;
  }

  /** A point of a widget's middle line in the scene: 0 is its left end, 1 its right one. */
  placeOf({ box }: Widget, part: number, out: Vector3): Vector3 {
    const { width, height } = this.options;
    out.set((box.x + part * box.w - width / 2) / 1000, (height / 2 - box.y - box.h / 2) / 1000, 0);
    return out.applyMatrix4(this.mesh.matrixWorld);
  }

  /** A point of the panel's plane in the scene as millimetres from the upper left corner. */
  toLocal(point: Vector3): { x: number; y: number; z: number } {
    const at = this.mesh.worldToLocal(this.corner.copy(point));
    at.set(1000 * at.x + this.options.width / 2, this.options.height / 2 - 1000 * at.y, at.z);
    return at;
  }

  readTheme(): void {
    this.painter.readColors();
    this.renew();
  }

  /** Paints what changed; call once a picture. */
  update(): void {
    if (!this.isOld || !this.mesh.visible) return;
    this.isOld = false;
    const { painter, options } = this;
    const { context } = painter;
    const all: Box = { x: 0, y: 0, w: options.width, h: options.height };
    context.setTransform(FINENESS, 0, 0, FINENESS, 0, 0);
    context.clearRect(0, 0, all.w, all.h);
    painter.fill(all, CORNER, "panel", 0.96);
    painter.outline(all, CORNER, "line", 0.8);
    if (options.hasBar) {
      painter.fill({ x: options.width / 2 - 20, y: 3.5, w: 40, h: 2.5 }, 1.25, this.hovered === "bar" ? "accent" : "line");
      painter.text(options.title, 14, BAR / 2 + 3, { size: TEXT, bold: true, width: options.width - 70 });
    }
    for (const widget of this.widgets) {
      context.save();
      widget.paint(painter, { hover: this.hovered === widget.id, pressed: this.pressed === widget.id });
      context.restore();
    }
    this.texture.needsUpdate = true;
  }
}

export function inBox({ x, y, w, h }: Box, atX: number, atY: number): boolean {
  return atX >= x && atX <= x + w && atY >= y && atY <= y + h;
}
