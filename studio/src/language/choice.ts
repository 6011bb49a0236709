// SPDX-License-Identifier: MIT
// Which language the page speaks. It is settled once, when the page is loaded.

/** Languages with a dictionary, by their names in themselves. */
export const LANGUAGES = { en: "English", zh: "简体中文" } as const;
export type Language = keyof typeof LANGUAGES;
/** `pseudo` is for tests: English with a mark around each translated text. */
export type Spoken = Language | "pseudo";

const PLACE = "embody.language";
/** Names for `<html lang>`; the one of Chinese also decides which forms of the characters the browser takes. */
export const TAGS: Record<Spoken, string> = { en: "en", zh: "zh-CN", pseudo: "en-XA" };

function isLanguage(name: string | null): name is Language {
  return name !== null && Object.hasOwn(LANGUAGES, name);
}

/** What the user has chosen; null: as the system. */
export function chosenLanguage(): Language | null {
  try {
    const kept = localStorage.getItem(PLACE);
    return isLanguage(kept) ? kept : null;
  } catch {
    return null;
  }
}

/** Keeps the user's choice, null for the system's language, and loads the page again in it. */
export function chooseLanguage(language: Language | null): void {
  try {
    if (language) localStorage.setItem(PLACE, language);
    else localStorage.removeItem(PLACE);
  } catch {
    // Where the user lets the browser store nothing, the page stays as it is.
    return;
  }
  const address = new URL(location.href);
  address.searchParams.delete("lang");
  location.replace(address);
}

/** The first of the system's languages that there is a dictionary for. */
function systemLanguage(): Language {
  for (const wanted of navigator.languages) {
    const [name] = wanted.toLowerCase().split("-");
    if (isLanguage(name ?? null)) return name as Language;
  }
  return "en";
}

/** The address (`?lang=`) is asked first, then what the user has chosen, then the system. */
export function spokenLanguage(): Spoken {
  const asked = new URLSearchParams(location.search).get("lang");
  if (asked === "pseudo" || isLanguage(asked)) return asked;
  return chosenLanguage() ?? systemLanguage();
}
