// SPDX-License-Identifier: MIT
import { Color, type Object3D } from "three";
import type { View } from "./view";

/** A side of a picture that is drawn at once is at most this long, pixels; larger ones are drawn in tiles. */
const LONGEST_TILE = 4096;
/** What browsers allow of a canvas: a side, and all pixels. */
export const LONGEST_SIDE = 16384;
export const MOST_PIXELS = 134_000_000;
/** Without antialiasing each pixel is drawn as so many by so many. */
const FINENESS = 2;

/** Draws pictures of another size than the page's, without handles, outlines and people. The page stands still until end(). */
export class Capture {
  private readonly pixelRatio: number;
  private readonly hidden: Object3D[];
  private readonly fineness: number;

  constructor(
    private readonly view: View,
    readonly width: number,
    readonly height: number,
  ) {
    view.halt();
    view.isCapturing = true;
    this.pixelRatio = view.renderer.getPixelRatio();
    this.fineness = view.hasSmoothEdges ? 1 : FINENESS;
    const tools: readonly Object3D[] = [view.outline.group, view.people.group, view.collision.group, view.pins.points];
    this.hidden = view.scene.children.filter((child) => child.visible && (tools.includes(child) || child.type === "TransformControlsRoot"));
    for (const each of this.hidden) each.visible = false;
    view.renderer.setPixelRatio(1);
    view.rig.fit(width / height);
    view.canvas.classList.add("capturing");
  }

  /** Draws the scene as it is on a canvas of this picture's size. */
  drawOn(target: OffscreenCanvas): void {
    const pen = target.getContext("2d")!;
    pen.imageSmoothingQuality = "high";
    this.eachTile((x, y, width, height) => pen.drawImage(this.view.canvas, x, y, width, height));
  }

  /** The same with what is behind the scene left transparent. */
  drawTransparentOn(target: OffscreenCanvas): void {
    const { scene, environment } = this.view;
    const background = scene.background;
    const grid = environment.isGridShown;
    environment.showGrid(false);
    const over = (color: number): OffscreenCanvas => {
      scene.background = new Color(color);
      const drawn = new OffscreenCanvas(this.width, this.height);
      this.drawOn(drawn);
      return drawn;
    };
    const onBlack = over(0x000000);
    const onWhite = over(0xffffff);
    scene.background = background;
    environment.showGrid(grid);
    separate(onBlack, onWhite, target);
  }

  end(): void {
    const { view } = this;
    for (const each of this.hidden) each.visible = true;
    view.canvas.classList.remove("capturing");
    view.renderer.setPixelRatio(this.pixelRatio);
    view.isCapturing = false;
    view.resize();
    view.resume();
  }

  private eachTile(put: (x: number, y: number, width: number, height: number) => void): void {
    const { renderer, rig } = this.view;
    const gl = renderer.getContext();
    const most = Math.min(LONGEST_TILE, gl.getParameter(gl.MAX_RENDERBUFFER_SIZE) as number, gl.getParameter(gl.MAX_TEXTURE_SIZE) as number);
    const side = Math.floor(most / this.fineness);
    for (let y = 0; y < this.height; y += side)
      for (let x = 0; x < this.width; x += side) {
        const width = Math.min(side, this.width - x);
        const height = Math.min(side, this.height - y);
        renderer.setSize(width * this.fineness, height * this.fineness, false);
        rig.camera.setViewOffset(this.width, this.height, x, y, width, height);
        this.view.render();
        put(x, y, width, height);
      }
    rig.camera.clearViewOffset();
  }
}

/** A thing of colour c that covers the share a of a pixel is a c on black, and 1 − a more on white. */
function separate(onBlack: OffscreenCanvas, onWhite: OffscreenCanvas, target: OffscreenCanvas): void {
  const pen = target.getContext("2d")!;
  const rows = 256;
  for (let y = 0; y < target.height; y += rows) {
    const height = Math.min(rows, target.height - y);
    const black = onBlack.getContext("2d")!.getImageData(0, y, target.width, height);
    const white = onWhite.getContext("2d")!.getImageData(0, y, target.width, height).data;
    const { data } = black;
    for (let at = 0; at < data.length; at += 4) {
      const behind = Math.max(0, (white[at]! - data[at]! + white[at + 1]! - data[at + 1]! + white[at + 2]! - data[at + 2]!) / 3);
      const cover = 1 - behind / 255;
      for (let channel = 0; channel < 3; ++channel) data[at + channel] = cover > 0 ? data[at + channel]! / cover : 0;
      data[at + 3] = 255 * cover;
    }
    pen.putImageData(black, 0, y);
  }
}
