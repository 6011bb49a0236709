// SPDX-License-Identifier: MIT

/** A text with places for what varies, such as "Move {{name}}". */
interface Pattern {
  /** What may stand for the placeholders, as short as can be and as long as can be. */
  shapes: RegExp[];
  names: string[];
  translated: string;
  /** How many letters are always there: the more, the more exactly it fits. */
  fixed: number;
}

/** Placeholders of this name hold a text that has a translation of its own. */
const NESTED = /^text\d*$/;
/** Names of categories and materials. */
const WORD = /^[\da-z][-\da-z ]*$/;
const PLACEHOLDER = /\{\{(\w+)\}\}/g;

/** Finds translations of the server's texts, which come as finished sentences. */
export class ServerTexts {
  private readonly patterns: Pattern[];
  /** Words by their translations; filled when first asked for. */
  private readonly words = new Map<string, string>();
  private readonly known = new Map<string, string | null>();

  /** Keys are English texts; those with placeholders are patterns. `{{text}}` stands for a text that is itself in the dictionary, or stays. */
  constructor(private readonly dictionary: Record<string, string>) {
    this.patterns = Object.entries(dictionary)
      .filter(([key]) => key.includes("{{"))
      .map(([key, translated]) => patternOf(key, translated))
      .sort((a, b) => b.fixed - a.fixed);
  }

  /** The translation, or null where there is none. */
  translate(text: string): string | null {
    let found = this.known.get(text);
    if (found === undefined) this.known.set(text, (found = this.find(text)));
    return found;
  }

  /** The English word of a translated one, or null. */
  original(word: string): string | null {
    const { words } = this;
    if (words.size === 0) for (const [key, translated] of Object.entries(this.dictionary)) if (WORD.test(key) && !words.has(translated)) words.set(translated, key);
    return words.get(word.trim()) ?? null;
  }

  private find(text: string): string | null {
    if (Object.hasOwn(this.dictionary, text)) return this.dictionary[text]!;
    for (const pattern of this.patterns) {
      const values = this.valuesOf(pattern, text);
      if (!values) continue;
      return pattern.translated.replace(PLACEHOLDER, (_, name: string) => {
        const value = values.get(name) ?? "";
        return NESTED.test(name) ? (this.translate(value) ?? value) : value;
      });
    }
    return null;
  }

  /** What stands for the placeholders. Of "Absorption of red light of Milk" it tells the label from the name by what the dictionary has. */
  private valuesOf({ shapes, names }: Pattern, text: string): Map<string, string> | null {
    const ways = shapes.flatMap((shape) => {
      const match = shape.exec(text);
      return match ? [new Map(names.map((name, at) => [name, match[at + 1]!]))] : [];
    });
    const first = names[0]!;
    const isKnown = (way: Map<string, string>) => NESTED.test(first) && Object.hasOwn(this.dictionary, way.get(first)!);
    return ways.find(isKnown) ?? ways[0] ?? null;
  }
}

function patternOf(key: string, translated: string): Pattern {
  const pieces = key.split(PLACEHOLDER);
  const names = pieces.filter((_, at) => at % 2 === 1);
  const shape = (any: string) => new RegExp(`^${pieces.map((piece, at) => (at % 2 === 1 ? any : piece.replace(/[.*+?^${}()|[\]\\]/g, "\\$&"))).join("")}$`, "s");
  return { shapes: [shape("(.+?)"), shape("(.+)")], names, translated, fixed: key.replace(PLACEHOLDER, "").length };
}
