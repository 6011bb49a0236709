// SPDX-License-Identifier: MIT
import type { IconName } from "../../tools/icons";
import type { Box } from "./painter";
import { button, type Widget } from "./widgets";
import { t } from "../../language";

const ROWS = ["1234567890", "qwertyuiop", "asdfghjkl-", "zxcvbnm"];
/** mm */
const GAP = 4;

export interface KeyboardOptions {
  box: Box;
  type: (text: string) => void;
  erase: () => void;
  done: () => void;
  /** Hears words, where the browser can. */
  listen: (() => void) | null;
  hears: boolean;
}

/** The keys of a keyboard on a panel; a key is at least 25 mm wide and high on a panel of 400 mm. */
export function keyboard({ box, type, erase, done, listen, hears }: KeyboardOptions): Widget[] {
  const width = (box.w - 9 * GAP) / 10;
  const height = (box.h - 4 * GAP) / 5;
  const at = (column: number, row: number, columns = 1): Box => ({
    x: box.x + column * (width + GAP),
    y: box.y + row * (height + GAP),
    w: columns * width + (columns - 1) * GAP,
    h: height,
  });
  const key = (id: string, place: Box, run: () => void, face: { label?: string; icon?: IconName; on?: boolean }) => button({ id: `key-${id}`, box: place, run, ...face });
  const letters = ROWS.flatMap((row, line) => [...row].map((letter, column) => key(letter, at(column, line), () => type(letter), { label: letter })));
  return [
    ...letters,
    key("erase", at(8, 3, 2), erase, { icon: "backspace" }),
    ...(listen ? [key("listen", at(0, 4, 2), listen, { icon: "microphone", on: hears })] : []),
    key("space", at(listen ? 2 : 0, 4, listen ? 6 : 8), () => type(" "), { label: t("space") }),
    key("done", at(8, 4, 2), done, { label: t("OK") }),
  ];
}

interface Recognition {
  lang: string;
  start(): void;
  onresult: ((event: { results: { 0: { transcript: string } }[] }) => void) | null;
  onend: (() => void) | null;
}

/** Hears a few words with the browser's speech recognition; null where it has none. */
export function speech(): ((heard: (words: string) => void, ended: () => void) => void) | null {
  const page = window as unknown as Record<"SpeechRecognition" | "webkitSpeechRecognition", (new () => Recognition) | undefined>;
  const Made = page.SpeechRecognition ?? page.webkitSpeechRecognition;
  if (!Made) return null;
  return (heard, ended) => {
    const recognition = new Made();
    recognition.lang = navigator.language;
    recognition.onresult = ({ results }) => heard(results[0]![0].transcript);
    recognition.onend = ended;
    recognition.start();
  };
}
