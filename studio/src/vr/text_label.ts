// SPDX-License-Identifier: MIT
import { CanvasTexture, Mesh, MeshBasicMaterial, PlaneGeometry, Quaternion, SRGBColorSpace, Vector3 } from "three";
import { Painter } from "./ui/painter";

/** mm, and pixels a millimetre. */
const WIDTH = 220;
const HEIGHT = 26;
const FINENESS = 2;
/** Letters keep this part of their distance in height: 18 mm at 0.8 m are 1.3°. */
const SIZE_AT = 0.8;

/** A line of text in the scene that faces the eyes and is equally large at any distance. */
export class TextLabel {
  readonly mesh: Mesh<PlaneGeometry, MeshBasicMaterial>;
  text = "";
  private readonly painter: Painter;
  private readonly texture: CanvasTexture;
  private readonly eyes = new Vector3();
  private readonly turn = new Quaternion();

  constructor() {
    const canvas = document.createElement("canvas");
    canvas.width = WIDTH * FINENESS;
    canvas.height = HEIGHT * FINENESS;
    this.painter = new Painter(canvas.getContext("2d")!);
    this.texture = new CanvasTexture(canvas);
    this.texture.colorSpace = SRGBColorSpace;
    this.mesh = new Mesh(new PlaneGeometry(WIDTH / 1000, HEIGHT / 1000), new MeshBasicMaterial({ map: this.texture, transparent: true, depthTest: false, depthWrite: false, toneMapped: false, fog: false }));
    this.mesh.renderOrder = 1200;
    this.mesh.frustumCulled = false;
    this.mesh.raycast = () => {};
    this.mesh.visible = false;
  }

  hide(): void {
    this.mesh.visible = false;
  }

  /** Shows a text at a point of the scene, before the eyes of a head. */
  show(text: string, point: Vector3, head: { getWorldPosition(out: Vector3): Vector3; getWorldQuaternion(out: Quaternion): Quaternion }): void {
    this.mesh.visible = true;
    this.mesh.position.copy(point);
    this.mesh.quaternion.copy(head.getWorldQuaternion(this.turn));
    this.mesh.scale.setScalar(head.getWorldPosition(this.eyes).distanceTo(point) / SIZE_AT);
    if (text === this.text) return;
    this.text = text;
    this.paint();
  }

  private paint(): void {
    const { painter } = this;
    const { context } = painter;
    context.setTransform(FINENESS, 0, 0, FINENESS, 0, 0);
    context.clearRect(0, 0, WIDTH, HEIGHT);
    context.font = "600 18px system-ui, sans-serif";
    const width = Math.min(context.measureText(this.text).width + 22, WIDTH);
    painter.fill({ x: (WIDTH - width) / 2, y: 1, w: width, h: HEIGHT - 2 }, 12, "panel", 0.92);
    painter.text(this.text, WIDTH / 2, HEIGHT / 2 + 0.5, { size: 18, bold: true, align: "center", width: WIDTH - 12 });
    this.texture.needsUpdate = true;
  }
}
