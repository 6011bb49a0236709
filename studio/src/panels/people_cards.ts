// SPDX-License-Identifier: MIT
import { memberName } from "../document/people";
import type { Parts } from "../parts";
import { around, element, GAP, setText } from "./element";
import { t, translateServerText } from "../language";

/** How often a countdown is written. */
const COUNT_EVERY_MS = 250;

type CardName = "question" | "waiting" | "name";
const LABELS: Record<CardName, string> = { question: t("Somebody wants to open another scene"), waiting: t("Waiting for the others"), name: t("Your name") };

type CardParts = Pick<Parts, "preferences" | "server" | "people" | "opening">;

/** Cards over the scene about the others: somebody wants to open another scene, who is waited for, and how one is called. */
export class PeopleCards {
  readonly root = element("div", { class: "cards" });
  private readonly cards = new Map<CardName, { key: number; root: HTMLElement; count: HTMLElement | null; until: number }>();

  constructor(private readonly parts: CardParts) {
    parts.opening.changed.on(() => this.followOpening());
    parts.people.changed.on(() => (this.askName(), this.followOpening()));
    setInterval(() => this.countDown(), COUNT_EVERY_MS);
  }

  private followOpening(): void {
    const { opening, server } = this.parts;
    const { question, waiting } = opening;
    if (question) {
      const answer = (agrees: boolean): void => {
        opening.end(question.question);
        void server.command("scene.answer", { question: question.question, agrees });
      };
      this.put("question", question.question, question.until, (count) => [
        element("p", {}, element("strong", {}, t("{{sentence}}.", { sentence: translateServerText(question.text) }))),
        element("p", { class: "note" }, ...around(t("Unsaved work stays among the recovered scenes. It is opened in {{time}}.", { time: GAP }), count)),
        buttons(
          element("button", { "data-testid": "question-refuse", onclick: () => answer(false) }, t("Not now")),
          element("button", { class: "primary", "data-testid": "question-agree", onclick: () => answer(true) }, t("Agree")),
        ),
      ]);
    } else this.remove("question");
    if (waiting) {
      // The server tells everybody that the question is over.
      const cancel = () => void server.command("scene.answer", { question: waiting.question, agrees: false });
      this.put("waiting", waiting.question, waiting.until, (count) => [
        element("p", {}, t("Waiting for {{names}}…", { names: this.names(waiting.asked) })),
        element("p", { class: "note" }, ...around(t("The scene is opened when they agree, or in {{time}}.", { time: GAP }), count)),
        buttons(element("button", { "data-testid": "waiting-cancel", onclick: cancel }, t("Cancel"))),
      ]);
    } else this.remove("waiting");
  }

  private names(clients: readonly number[]): string {
    const members = clients.flatMap((client) => this.parts.people.member(client) ?? []);
    return members.map(memberName).join(t(", ")) || t("the others");
  }

  /** Asks for a name once, when somebody else is here for the first time. */
  private askName(): void {
    const { people, preferences } = this.parts;
    if (people.others.length === 0 || preferences.get("userName") || preferences.get("nameAsked")) {
      this.remove("name");
      return;
    }
    const input = element("input", { type: "text", maxlength: 40, placeholder: t("Your name"), "aria-label": t("Your name"), autocomplete: "given-name", "data-testid": "name-input" });
    const done = (name: string): void => {
      preferences.set("nameAsked", true);
      if (name) preferences.set("userName", name);
      this.remove("name");
    };
    const submit = (event: Event): void => {
      event.preventDefault();
      done(input.value.trim());
    };
    this.put("name", 0, 0, () => [
      element("p", {}, element("strong", {}, t("You are not alone here.")), " ", t("What may the others call you?")),
      element("form", { onsubmit: submit }, input, buttons(element("button", { type: "button", "data-testid": "name-later", onclick: () => done("") }, t("Not now")), element("button", { class: "primary", type: "submit" }, t("OK")))),
    ]);
  }

  /** Shows a card, unless it is shown already; `until` is the end of its countdown, 0: none. */
  private put(name: CardName, key: number, until: number, make: (count: HTMLElement) => HTMLElement[]): void {
    if (this.cards.get(name)?.key === key) return;
    this.remove(name);
    const count = element("span", { class: "countdown", "data-testid": `${name}-seconds` });
    const root = element("section", { class: "card", role: "alertdialog", "aria-label": LABELS[name], "data-testid": `card-${name}` }, ...make(count));
    this.cards.set(name, { key, root, count: until > 0 ? count : null, until });
    this.root.append(root);
    this.countDown();
  }

  private remove(name: CardName): void {
    this.cards.get(name)?.root.remove();
    this.cards.delete(name);
  }

  private countDown(): void {
    for (const { count, until } of this.cards.values()) if (count) setText(count, `${Math.max(0, Math.ceil((until - performance.now()) / 1000))} s`);
  }
}

function buttons(...all: HTMLElement[]): HTMLElement {
  return element("div", { class: "card-buttons" }, ...all);
}
