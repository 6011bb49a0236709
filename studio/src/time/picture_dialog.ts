// SPDX-License-Identifier: MIT
import { dialogButtons, openDialog } from "../panels/dialogs";
import { element, setText } from "../panels/element";
import type { Parts } from "../parts";
import { Capture, LONGEST_SIDE, MOST_PIXELS } from "../view/capture";
import type { View } from "../view/view";
import { download } from "./download";
import { PICTURE_SIZES } from "./sizes";
import { t } from "../language";

/** The scene as the camera sees it, as a PNG file of any size; `isTransparent`: without what is behind it. */
export async function drawPicture(view: View, width: number, height: number, isTransparent: boolean): Promise<Blob> {
  const canvas = new OffscreenCanvas(width, height);
  const capture = new Capture(view, width, height);
  try {
    view.advance(performance.now());
    if (isTransparent) capture.drawTransparentOn(canvas);
    else capture.drawOn(canvas);
  } finally {
    capture.end();
  }
  return canvas.convertToBlob({ type: "image/png" });
}

/** Why there is no picture of this size; null where there is. */
function sizeFault(width: number, height: number): string | null {
  if (!Number.isInteger(width) || !Number.isInteger(height) || width < 16 || height < 16) return t("Give whole numbers of pixels, at least 16.");
  if (Math.max(width, height) > LONGEST_SIDE) return t("A side has at most {{side}} pixels.", { side: LONGEST_SIDE });
  return width * height > MOST_PIXELS ? t("A picture has at most {{number}} million pixels.", { number: MOST_PIXELS / 1e6 }) : null;
}

/** Asks for the size of a picture, and saves it. */
export function openPicture(parts: Pick<Parts, "notices" | "document" | "view">): void {
  const { canvas } = parts.view;
  const field = (label: string, testId: string, value: number) => element("input", { type: "number", min: 16, max: LONGEST_SIDE, value, "aria-label": label, "data-testid": testId });
  const width = field(t("Width, pixels"), "picture-width", 3840);
  const height = field(t("Height, pixels"), "picture-height", 2160);
  const clear = element("input", { type: "checkbox", "data-testid": "picture-transparent" });
  const note = element("p", { class: "note", role: "status", "data-testid": "picture-note" });
  const save = element("button", { class: "primary", type: "submit", "data-testid": "picture-save" }, t("Save"));
  const describe = (): void => {
    const fault = sizeFault(Number(width.value), Number(height.value));
    save.disabled = fault !== null;
    setText(note, fault ?? t("As the camera sees it, without handles and outlines."));
  };
  const put = (size: readonly [number, number]): void => {
    width.value = String(size[0]);
    height.value = String(size[1]);
    describe();
  };
  const shown: [number, number] = [Math.round(canvas.clientWidth * devicePixelRatio), Math.round(canvas.clientHeight * devicePixelRatio)];
  const sizes = [[t("as shown"), shown] as const, ...PICTURE_SIZES.slice(3).map((size) => [size.join(" × "), size] as const)];
  for (const each of [width, height]) each.addEventListener("input", describe);
  const form = element(
    "form",
    { class: "film-form", onsubmit: (event: Event) => void run(event) },
    element("div", { class: "size-buttons" }, ...sizes.map(([label, size]) => element("button", { type: "button", onclick: () => put(size) }, label))),
    element("label", { class: "film-row" }, element("span", {}, t("Width (pixels)")), width),
    element("label", { class: "film-row" }, element("span", {}, t("Height (pixels)")), height),
    element("label", { class: "option" }, clear, element("span", {}, t("Transparent behind the scene"))),
    note,
    dialogButtons(element("button", { type: "button", onclick: () => dialog.close() }, t("Cancel")), save),
  );
  const dialog = openDialog(t("Save a picture"), "picture-dialog", form);
  describe();

  async function run(event: Event): Promise<void> {
    event.preventDefault();
    if (save.disabled) return;
    save.disabled = true;
    try {
      download(await drawPicture(parts.view, Number(width.value), Number(height.value), clear.checked), `${parts.document.title || "scene"}.png`);
    } catch (error) {
      parts.notices.tell({ level: "error", text: t("The picture could not be drawn: {{message}}", { message: (error as Error).message }), remedy: t("Choose a smaller size.") });
    }
    dialog.close();
  }
}
