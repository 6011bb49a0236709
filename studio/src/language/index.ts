// SPDX-License-Identifier: MIT
// The page's texts in the user's language. English texts are the keys of the dictionaries.
//
// Modules that import this one wait until the dictionary is there (top-level await), so constants may be made of texts.
import { createInstance, type TOptions } from "i18next";
import { spokenLanguage, TAGS } from "./choice";
import en from "./en.json";
import { ServerTexts } from "./server_text";

type Dictionary = Record<string, string>;

/** The language of this page. */
export const language = spokenLanguage();
document.documentElement.lang = TAGS[language];

/** Dictionaries of the page's own texts and of the server's; English needs none. */
async function load(): Promise<{ own: Dictionary; server: Dictionary }> {
  if (language === "en") return { own: {}, server: {} };
  try {
    const [own, server, categories] = await Promise.all([import("./zh.json"), import("./zh_server.json"), import("./zh_categories.json")]);
    return { own: own.default, server: { ...categories.default, ...server.default } };
  } catch {
    // Without its dictionary the page still works, in English.
    return { own: {}, server: {} };
  }
}

const { own, server } = await load();
const locale = language === "zh" ? "zh" : "en";
/** For dates: in English pages as the system writes them. */
export const dateLocale = language === "zh" ? TAGS.zh : undefined;
const i18n = createInstance();
// English has an entry only where the number decides the form.
await i18n.init({
  lng: locale,
  fallbackLng: false,
  resources: { [locale]: { translation: locale === "zh" ? own : en } },
  keySeparator: false,
  nsSeparator: false,
  // Texts are put into text nodes and attributes, never into HTML.
  interpolation: { escapeValue: false, skipOnVariables: true },
});

/** Marks a text as translated, for the tests. */
function marked(text: string): string {
  return language === "pseudo" ? `⟦${text}⟧` : text;
}

const serverTexts = new ServerTexts(server);

/**
 * A text of the page in the user's language. `text` is the English one, a literal, and the key of the dictionaries; `values` fill its
 * placeholders: `t("{{name}} is ready", { name })`. `count` decides the plural, `context` tells equal English words apart.
 */
export function t(text: string, values: TOptions = {}): string {
  return marked(i18n.t(text, values));
}

/** A text that the server sends: from the dictionary of such texts where it has it, else as it came. */
export function translateServerText(text: string): string {
  if (language === "en" || text === "") return text;
  const known = serverTexts.translate(text);
  if (known === null) return text;
  return language === "pseudo" ? marked(text) : known;
}

/** A word of the server's, such as cast_iron, in the user's language; one that the dictionary does not have stays as it is. */
export function translatedWord(word: string): string {
  const plain = word.replaceAll("_", " ");
  const translated = translateServerText(plain);
  return translated === plain ? word : translated;
}

/** The server's word for one that the user typed: of a translation the English one, else what was typed. */
export function serverWord(typed: string): string {
  return serverTexts.original(typed) ?? typed;
}

/** A text of the server in English and in the user's language: what a search looks through. */
export function searchedText(text: string): string {
  const translated = translateServerText(text);
  return translated === text ? text : `${text} ${translated}`;
}

/** A number as people write it, with its thousands apart. */
export function countText(count: number): string {
  return count.toLocaleString(locale);
}
