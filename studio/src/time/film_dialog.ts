// SPDX-License-Identifier: MIT
import { dialogButtons, openDialog } from "../panels/dialogs";
import { element, setText, show } from "../panels/element";
import type { Parts } from "../parts";
import { download } from "./download";
import { type FilmPlan, picturesOf } from "./film_plan";
import { PICTURE_SIZES } from "./sizes";
import { t } from "../language";

const RATES: readonly [number, string][] = [
  [2, t("twice as fast")],
  [1, t("real time")],
  [0.5, t("½ speed")],
  [0.25, t("¼ speed")],
  [0.1, t("⅒ speed")],
];

/** Asks what to film, and makes the film; `openRecord` asks for a recording instead. */
export function openFilm(parts: Pick<Parts, "server" | "notices" | "document" | "motion" | "entities" | "take" | "view">, openRecord: () => void): void {
  const { take } = parts;
  const number = (label: string, testId: string, value: number) => element("input", { type: "number", step: "any", min: 0, value: value.toFixed(2), "aria-label": label, "data-testid": testId });
  const choice = (label: string, testId: string, entries: readonly (readonly [number | string, string])[], value: number | string) => {
    const made = element("select", { "aria-label": label, "data-testid": testId }, ...entries.map(([key, text]) => element("option", { value: key }, text)));
    made.value = String(value);
    return made;
  };
  const from = number(t("From, seconds"), "film-from", take.state.start);
  const to = number(t("To, seconds"), "film-to", take.state.end);
  const rate = choice(t("Speed"), "film-rate", RATES, 1);
  const fps = choice(t("Pictures a second"), "film-fps", [[24, t("24 a second")], [30, t("30 a second")], [60, t("60 a second")]], 30);
  const size = choice(t("Size"), "film-size", PICTURE_SIZES.map(([width, height]) => [`${width}x${height}`, `${width} × ${height}`] as const), "1280x720");
  const camera = choice(t("Camera"), "film-camera", [[0, t("stands as it is now")], [1, t("turns once about what it looks at")], [-1, t("turns once the other way")]], 0);
  const text = element("input", { type: "text", maxlength: 80, "aria-label": t("Text over the film"), "data-testid": "film-text" });
  const note = element("p", { class: "note", role: "status", "data-testid": "film-note" });
  const bar = element("progress", { "aria-label": t("Progress"), "data-testid": "film-progress", max: 1, value: 0 });
  const start = element("button", { class: "primary", type: "submit", "data-testid": "film-start" }, t("Make the film"));
  const gltf = element("button", { type: "button", "data-testid": "film-gltf", title: t("A binary glTF file of all things and their motion, for Blender and others"), onclick: () => void run(exportAnimation) }, t("Save as glTF animation"));
  const record = element("button", { type: "button", "data-testid": "film-record", title: t("Films the scene as you see it while you go on working"), onclick: () => (dialog.close(), openRecord()) }, t("Record what I do…"));
  const stop = element("button", { type: "button", "data-testid": "film-cancel", onclick: () => dialog.close() }, t("Cancel"));
  const running = new AbortController();

  const plan = (): FilmPlan => {
    const [width, height] = size.value.split("x").map(Number);
    return { from: Number(from.value), to: Number(to.value), rate: Number(rate.value), fps: Number(fps.value), width: width!, height: height!, turns: Number(camera.value), text: text.value.trim() };
  };
  const fault = ({ from: first, to: last }: FilmPlan): string | null => {
    if (!Number.isFinite(first) || !Number.isFinite(last) || last <= first) return t("The end must come after the beginning.");
    const { start: begin, end } = take.state;
    return first < begin - 0.01 || last > end + 0.01 ? t("Recorded is {{begin}} … {{end}} s.", { begin: begin.toFixed(2), end: end.toFixed(2) }) : null;
  };
  const describe = (): void => {
    const wanted = plan();
    const wrong = fault(wanted);
    start.disabled = gltf.disabled = wrong !== null;
    setText(note, wrong ?? t("{{seconds}} s of film, {{pictures}} pictures. Nobody else sees anything of it.", { seconds: ((wanted.to - wanted.from) / wanted.rate).toFixed(1), pictures: picturesOf(wanted) }));
  };
  const row = (label: string, ...fields: HTMLElement[]) => element("label", { class: "film-row" }, element("span", {}, label), ...fields);
  const fields = [from, to, rate, fps, size, camera, text];
  for (const field of fields) field.addEventListener("input", describe);
  const form = element(
    "form",
    { class: "film-form", onsubmit: (event: Event) => (event.preventDefault(), void run(exportFilm)) },
    row(t("From (s)"), from),
    row(t("To (s)"), to),
    row(t("Speed"), rate),
    row(t("Pictures"), fps),
    row(t("Size"), size),
    row(t("Camera"), camera),
    row(t("Text"), text),
    note,
    bar,
    dialogButtons(record, gltf, stop, start),
  );
  const dialog = openDialog(t("Make a film of the run"), "film-dialog", form);
  dialog.addEventListener("close", () => running.abort());
  show(bar, false);
  describe();

  const tell = (what: string) => (done: number, of: number) => {
    bar.value = done / of;
    setText(note, t("{{what}} {{done}} of {{of}}", { what, done, of }));
  };

  /** Does it with the fields locked and the bar shown, then closes. */
  async function run(work: (wanted: FilmPlan) => Promise<void>): Promise<void> {
    const wanted = plan();
    if (fault(wanted) || start.disabled) return;
    for (const field of [...fields, start, gltf, record]) field.disabled = true;
    show(bar, true);
    try {
      await work(wanted);
      dialog.close();
    } catch (error) {
      setText(note, (error as Error).message);
      show(bar, false);
    }
  }

  async function exportFilm(wanted: FilmPlan): Promise<void> {
    // The encoder's part of the page is loaded by who makes films.
    const { filmHindrance } = await import("./film_writer");
    const { makeFilm } = await import("./film");
    const hindrance = await filmHindrance(wanted.width, wanted.height);
    if (hindrance) throw new Error(hindrance);
    const film = await makeFilm(parts, wanted, tell(t("Picture")), running.signal);
    if (!film) return;
    download(film, `${parts.document.title || "scene"}.webm`);
    parts.notices.tell({ level: "info", text: t("The film is among your downloads ({{size}} MB)", { size: (film.size / 1e6).toFixed(1) }) });
  }

  async function exportAnimation(wanted: FilmPlan): Promise<void> {
    const { makeAnimation } = await import("./animation");
    const made = await makeAnimation(parts, wanted, tell(t("Moment")), running.signal);
    if (!made) return;
    download(made.file, `${parts.document.title || "scene"}.glb`);
    const remedy = made.still.length > 0 ? `${made.still.join("; ")}.` : undefined;
    parts.notices.tell({ level: "info", text: t("The animation is among your downloads"), ...(remedy && { remedy }) });
  }
}
