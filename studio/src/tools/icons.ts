// SPDX-License-Identifier: MIT

/** Strokes on a 16 × 16 grid; a leading "!" means filled. */
const ICONS = {
  select: "M4 2l8 6.5-3.6.5L10.5 13l-1.6.8L7 9.8 4 12z",
  move: "M8 1.5v13M1.5 8h13M8 1.5L6 3.5M8 1.5l2 2M8 14.5l-2-2M8 14.5l2-2M1.5 8l2-2M1.5 8l2 2M14.5 8l-2-2M14.5 8l-2 2",
  rotate: "M13 8a5 5 0 1 1-1.6-3.7M13.2 1.8v3h-3",
  scale: "M2.5 9.5v4h4v-4zM6.5 9.5L13 3M9 2.5h4.5V7",
  world: "M8 2a6 6 0 1 0 0 12A6 6 0 0 0 8 2zM2 8h12M8 2c-4 3.5-4 8.5 0 12M8 2c4 3.5 4 8.5 0 12",
  local: "M8 2l5.5 3v6L8 14l-5.5-3V5zM8 8v6M8 8L2.5 5M8 8l5.5-3",
  snap: "M4 2v6a4 4 0 0 0 8 0V2M4 5h0M2.5 4.5h3M10.5 4.5h3",
  play: "!M4 2.5v11l9-5.5z",
  pause: "!M4 2.5h3v11H4zM9 2.5h3v11H9z",
  step: "!M3 3v10l7-5zM11 3h2v10h-2z",
  stepBack: "M10 3.5L5.5 8l4.5 4.5",
  stepOn: "M6 3.5L10.5 8 6 12.5",
  toEnd: "!M3 3v10l7-5zM11 3h2v10h-2z",
  branch: "M4 2v12M4 10c0-4 7-2 7-6M9 6l2-2.5L13.5 6",
  film: "M2 3.5h12v9H2zM4.5 3.5v9M11.5 3.5v9M2 8h2.5M11.5 8H14",
  plot: "M2 2v12h12M4 11l3-4 3 2 4-6",
  reset: "!M13 3v10L6 8zM3 3h2v10H3z",
  keep: "M8 2v7M5 6.5L8 9.5l3-3M2.5 10v3.5h11V10",
  undo: "M3 6.5h7a3.5 3.5 0 0 1 0 7H6M3 6.5l3-3M3 6.5l3 3",
  redo: "M13 6.5H6a3.5 3.5 0 0 0 0 7h4M13 6.5l-3-3M13 6.5l-3 3",
  fresh: "M4 1.5h5.5L12.5 5v9.5H4zM9 1.5V5.5h3.5",
  open: "M1.5 13V3h4l1.5 2h6v2.5M1.5 13l2.5-5.5h11L12.5 13z",
  save: "M2.5 2.5h9l2 2v9h-11zM5 2.5v3.5h5V2.5M4.5 13.5v-5h7v5",
  tint: "M5 6.5a3 3 0 1 0 0 6 3 3 0 0 0 0-6zM11 6.5a3 3 0 1 0 0 6 3 3 0 0 0 0-6zM8 1.8a3 3 0 1 0 0 6 3 3 0 0 0 0-6z",
  options: "M2 4h7M12 4h2M2 8h2M7 8h7M2 12h6M11 12h3M10.5 2.5v3M5.5 6.5v3M9.5 10.5v3",
  help: "M5.5 6a2.5 2.5 0 1 1 3.6 2.2C8.3 8.6 8 9 8 10M8 12.6v.4",
  palette: "M2.5 4.5L6 8l-3.5 3.5M8 12h5.5",
  star: "M8 2l1.8 3.9 4.2.5-3.1 2.9.8 4.2L8 11.4l-3.7 2.1.8-4.2L2 6.4l4.2-.5z",
  close: "M4 4l8 8M12 4l-8 8",
  headset: "M2 5h12v6.5h-3.5L8 9.5l-2.5 2H2z",
  alignLeft: "M2.5 2v12M5 4h8v3H5zM5 9.5h5v3H5z",
  alignMiddle: "M8 2v12M3 4h10v3H3zM5 9.5h6v3H5z",
  alignRight: "M13.5 2v12M3 4h8v3H3zM6 9.5h5v3H6z",
  alignFar: "M2 2.5h12M4 5h3v8H4zM9.5 5h3v5h-3z",
  alignBetween: "M2 8h12M4 3h3v10H4zM9.5 5h3v6h-3z",
  alignNear: "M2 13.5h12M4 3h3v8H4zM9.5 6h3v5h-3z",
  alignBase: "!M2 13h12v1.2H2zM4 4h3v8H4zM9 8h3.5v4H9z",
  alignTop: "!M2 1.8h12V3H2zM4 4h3v8H4zM9 4h3.5v4H9z",
  gapsAcross: "M2 2v12M14 2v12M6.5 5h3v6h-3z",
  gapsAlong: "M2 2h12M2 14h12M5 6.5h6v3H5z",
  mirrorAcross: "M8 1.5v13M6 4L2 12h4zM10 4l4 8h-4z",
  mirrorAlong: "M1.5 8h13M4 6l8-4v4zM4 10l8 4v-4z",
  group: "M2 2h3M2 2v3M14 2h-3M14 2v3M2 14h3M2 14v-3M14 14h-3M14 14v-3M5 5h4v4H5zM8 8h3.5v3.5H8z",
  ungroup: "M2.5 2.5h5v5h-5zM8.5 8.5h5v5h-5zM10 3l3 3M13 3l-3 3",
  bin: "M3 4.5h10M6 4.5V2.5h4v2M4.5 4.5l.5 9h6l.5-9M7 7v4M9 7v4",
  apply: "M2 9V2.5h6.5M4.5 11.5V5h6.5M7 14V7.5h6.5V14z",
  foldLeft: "M10 3.5L5.5 8l4.5 4.5",
  foldRight: "M6 3.5L10.5 8 6 12.5",
  people: "M6 7.5a2.5 2.5 0 1 0 0-5 2.5 2.5 0 0 0 0 5zM1.5 13.5c0-3 2-4.5 4.5-4.5s4.5 1.5 4.5 4.5zM10.5 2.8a2.3 2.3 0 0 1 0 4.4M12 9.4c1.6.6 2.5 2 2.5 4.1",
  history: "M2.5 3v3.5H6M2.8 6.4A5.5 5.5 0 1 1 2.5 8.5M8 5.2V8.3l2.3 1.4",
  lock: "M3.5 7.5h9v6.5h-9zM5.5 7.5V5a2.5 2.5 0 0 1 5 0v2.5",
  unlock: "M3.5 7.5h9v6.5h-9zM5.5 7.5V4.5a2.5 2.5 0 0 1 4.9-.7",
  camera: "M2 5h3l1.2-2h3.6L11 5h3v8H2zM8 6.5a2.4 2.4 0 1 0 0 4.8 2.4 2.4 0 0 0 0-4.8z",
  copy: "M5.5 5.5h8v8h-8zM10.5 5.5v-3h-8v8h3",
  tape: "M1.5 6h13v4.5h-13zM4 6v2M6.5 6v3M9 6v2M11.5 6v3",
  house: "M2 7.5L8 2.5l6 5M3.5 6.5v7h9v-7M6.5 13.5v-4h3v4",
  person: "M8 2a1.6 1.6 0 1 0 0 3.2A1.6 1.6 0 0 0 8 2zM5 6.5h6M8 5.5v5M8 10.5l-2 4M8 10.5l2 4",
  models: "M8 2l5.5 3v6L8 14l-5.5-3V5zM8 8v6M8 8L2.5 5M8 8l5.5-3M5.2 3.5l5.6 3",
  sliders: "M3 2.5v11M8 2.5v11M13 2.5v11M1.5 10h3M6.5 5h3M11.5 9h3",
  gear: "M8 5.5a2.5 2.5 0 1 0 0 5 2.5 2.5 0 0 0 0-5zM8 1.5v2M8 12.5v2M1.5 8h2M12.5 8h2M3.4 3.4l1.4 1.4M11.2 11.2l1.4 1.4M3.4 12.6l1.4-1.4M11.2 4.8l1.4-1.4",
  leave: "M9 2.5H3v11h6M6.5 8h7.5M11.5 5.5L14 8l-2.5 2.5",
  microphone: "M8 1.8a2 2 0 0 0-2 2v4a2 2 0 0 0 4 0v-4a2 2 0 0 0-2-2zM3.8 7.5a4.2 4.2 0 0 0 8.4 0M8 11.7v2.5",
  search: "M7 2.5a4.5 4.5 0 1 0 0 9 4.5 4.5 0 0 0 0-9zM10.3 10.3l3.7 3.7",
  backspace: "M5.5 3.5h9v9h-9L1.5 8zM8 6l4 4M12 6l-4 4",
  up: "M3.5 10.5L8 5.5l4.5 5",
  down: "M3.5 5.5l4.5 5 4.5-5",
  wall: "M1.5 4h13v8h-13zM1.5 8h13M6 4v4M10.5 4v4M4 8v4M8.5 8v4M12.5 8v4",
  room: "M2 2h12v12H9.5M6.5 14H2zM6.5 14a3 3 0 0 1 3-3v3",
  door: "M4 14V2h8v12M2 14h12M9.8 8.2v.4",
  window: "M2.5 2.5h11v11h-11zM8 2.5v11M2.5 8h11",
  hole: "M1.5 3h13v11H11V7H5v7H1.5z",
  plan: "M2 2h12v12H2zM2 9h5M7 6v3M10 9h4M10 14V9",
  drop: "M8 2v8M5 7.5L8 10.5l3-3M2.5 13.5h11",
} as const;

export type IconName = keyof typeof ICONS;

/** The strokes of an icon on a 16 × 16 grid, and whether they are filled. */
export function strokesOf(name: IconName): { path: string; filled: boolean } {
  const strokes: string = ICONS[name];
  const filled = strokes.startsWith("!");
  return { path: filled ? strokes.slice(1) : strokes, filled };
}

export function icon(name: IconName): SVGSVGElement {
  const drawing = document.createElementNS("http://www.w3.org/2000/svg", "svg");
  const path = document.createElementNS("http://www.w3.org/2000/svg", "path");
  const { path: strokes, filled } = strokesOf(name);
  drawing.setAttribute("viewBox", "0 0 16 16");
  drawing.setAttribute("aria-hidden", "true");
  drawing.setAttribute("class", filled ? "icon icon-filled" : "icon");
  path.setAttribute("d", strokes);
  drawing.append(path);
  return drawing;
}
