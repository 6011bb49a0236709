// SPDX-License-Identifier: MIT
import { dialogButtons, openDialog } from "../panels/dialogs";
import { element, setText, show } from "../panels/element";
import type { Parts } from "../parts";
import { download } from "./download";
import { type FilmPlan, picturesOf } from "./film_plan";
import { PICTURE_SIZES } from "./sizes";

const RATES: readonly [number, string][] = [
  [2, "twice as fast"],
  [1, "real time"],
  [0.5, "½ speed"],
  [0.25, "¼ speed"],
  [0.1, "⅒ speed"],
];

/** Asks what to film, and makes the film. */
export function openFilm(parts: Pick<Parts, "server" | "notices" | "document" | "motion" | "entities" | "take" | "view">): void {
  const { take } = parts;
  const number = (label: string, testId: string, value: number) => element("input", { type: "number", step: "any", min: 0, value: value.toFixed(2), "aria-label": label, "data-testid": testId });
  const choice = (label: string, testId: string, entries: readonly (readonly [number | string, string])[], value: number | string) => {
    const made = element("select", { "aria-label": label, "data-testid": testId }, ...entries.map(([key, text]) => element("option", { value: key }, text)));
    made.value = String(value);
    return made;
  };
  const from = number("From, seconds", "film-from", take.state.start);
  const to = number("To, seconds", "film-to", take.state.end);
  const rate = choice("Speed", "film-rate", RATES, 1);
  const fps = choice("Pictures a second", "film-fps", [[24, "24 a second"], [30, "30 a second"], [60, "60 a second"]], 30);
  const size = choice("Size", "film-size", PICTURE_SIZES.map(([width, height]) => [`${width}x${height}`, `${width} × ${height}`] as const), "1280x720");
  const camera = choice("Camera", "film-camera", [[0, "stands as it is now"], [1, "turns once about what it looks at"], [-1, "turns once the other way"]], 0);
  const note = element("p", { class: "note", role: "status", "data-testid": "film-note" });
  const bar = element("progress", { "aria-label": "Progress", "data-testid": "film-progress", max: 1, value: 0 });
  const start = element("button", { class: "primary", type: "submit", "data-testid": "film-start" }, "Make the film");
  const gltf = element("button", { type: "button", "data-testid": "film-gltf", title: "A binary glTF file of all things and their motion, for Blender and others", onclick: () => void run(exportAnimation) }, "Save as glTF animation");
  const stop = element("button", { type: "button", "data-testid": "film-cancel", onclick: () => dialog.close() }, "Cancel");
  const running = new AbortController();

  const plan = (): FilmPlan => {
    const [width, height] = size.value.split("x").map(Number);
    return { from: Number(from.value), to: Number(to.value), rate: Number(rate.value), fps: Number(fps.value), width: width!, height: height!, turns: Number(camera.value) };
  };
  const fault = ({ from: first, to: last }: FilmPlan): string | null => {
    if (!Number.isFinite(first) || !Number.isFinite(last) || last <= first) return "The end must come after the beginning.";
    const { start: begin, end } = take.state;
    return first < begin - 0.01 || last > end + 0.01 ? `Recorded is ${begin.toFixed(2)} … ${end.toFixed(2)} s.` : null;
  };
  const describe = (): void => {
    const wanted = plan();
    const wrong = fault(wanted);
    start.disabled = gltf.disabled = wrong !== null;
    setText(note, wrong ?? `${((wanted.to - wanted.from) / wanted.rate).toFixed(1)} s of film, ${picturesOf(wanted)} pictures. Nobody else sees anything of it.`);
  };
  const row = (label: string, ...fields: HTMLElement[]) => element("label", { class: "film-row" }, element("span", {}, label), ...fields);
  const fields = [from, to, rate, fps, size, camera];
  for (const field of fields) field.addEventListener("input", describe);
  const form = element(
    "form",
    { class: "film-form", onsubmit: (event: Event) => (event.preventDefault(), void run(exportFilm)) },
    row("From (s)", from),
    row("To (s)", to),
    row("Speed", rate),
    row("Pictures", fps),
    row("Size", size),
    row("Camera", camera),
    note,
    bar,
    dialogButtons(gltf, stop, start),
  );
  const dialog = openDialog("Make a film of the run", "film-dialog", form);
  dialog.addEventListener("close", () => running.abort());
  show(bar, false);
  describe();

  const tell = (what: string) => (done: number, of: number) => {
    bar.value = done / of;
    setText(note, `${what} ${done} of ${of}`);
  };

  /** Does it with the fields locked and the bar shown, then closes. */
  async function run(work: (wanted: FilmPlan) => Promise<void>): Promise<void> {
    const wanted = plan();
    if (fault(wanted) || start.disabled) return;
    for (const field of [...fields, start, gltf]) field.disabled = true;
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
    const { filmHindrance, makeFilm } = await import("./film");
    const hindrance = await filmHindrance(wanted.width, wanted.height);
    if (hindrance) throw new Error(hindrance);
    const film = await makeFilm(parts, wanted, tell("Picture"), running.signal);
    if (!film) return;
    download(film, `${parts.document.title || "scene"}.webm`);
    parts.notices.tell({ level: "info", text: `The film is among your downloads (${(film.size / 1e6).toFixed(1)} MB)` });
  }

  async function exportAnimation(wanted: FilmPlan): Promise<void> {
    const { makeAnimation } = await import("./animation");
    const made = await makeAnimation(parts, wanted, tell("Moment"), running.signal);
    if (!made) return;
    download(made.file, `${parts.document.title || "scene"}.glb`);
    const remedy = made.still.length > 0 ? `${made.still.join("; ")}.` : undefined;
    parts.notices.tell({ level: "info", text: "The animation is among your downloads", ...(remedy && { remedy }) });
  }
}
