// SPDX-License-Identifier: MIT
/** Height of the letters, and the edge around them, as parts of the picture's height. */
const LETTERS = 1 / 22;
const EDGE = 1 / 40;

/** Writes a line of text over the lower left of a picture; an empty one writes nothing. */
export function drawCaption(target: OffscreenCanvas, text: string): void {
  if (!text) return;
  const pen = target.getContext("2d")!;
  const size = Math.round(target.height * LETTERS);
  const edge = Math.round(target.height * EDGE);
  pen.font = `600 ${size}px system-ui, sans-serif`;
  drawBox(pen, text, edge, target.height - edge - 2 * size, size, target.width - 2 * edge);
}

/** A line of text on a dark box, `size` pixels high; its left upper corner is at x, y. */
export function drawBox(pen: OffscreenCanvasRenderingContext2D, text: string, x: number, y: number, size: number, widest: number): void {
  pen.textBaseline = "middle";
  const width = Math.min(pen.measureText(text).width, widest - size);
  pen.fillStyle = "rgb(16 20 26 / 72%)";
  pen.beginPath();
  pen.roundRect(x, y, width + size, 2 * size, size / 3);
  pen.fill();
  pen.fillStyle = "#fff";
  pen.fillText(text, x + size / 2, y + size, width);
}
