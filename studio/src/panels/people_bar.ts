// SPDX-License-Identifier: MIT
import { initials, memberName, rightsText } from "../document/people";
import type { Member } from "../connection/messages";
import type { Parts } from "../parts";
import { inkOn } from "../view/name_tag";
import { lookOf } from "../view/people_view";
import { icon } from "../tools/icons";
import { openTextDialog } from "./dialogs";
import { element } from "./element";
import { openPeople } from "./people_dialog";
import { t } from "../language";

/** Everybody in the session as coloured initials, while somebody else is here; a click looks where they look. Then what this page may do, if not all, and who else may come. */
export class PeopleBar {
  readonly root = element("div", { class: "people", role: "group", "aria-label": t("People in this scene"), "data-testid": "people" });

  constructor(private readonly parts: Pick<Parts, "preferences" | "server" | "notices" | "people" | "view">) {
    parts.people.changed.on(() => this.fill());
    this.fill();
  }

  private fill(): void {
    const { people } = this.parts;
    // This page first, the others as they came.
    const members = [...people.members].sort((a, b) => Number(people.isSelf(b)) - Number(people.isSelf(a)));
    const { edit, run } = people.rights;
    this.root.replaceChildren(
      ...(people.others.length > 0 ? members.map((member) => this.button(member)) : []),
      ...(edit && run ? [] : [element("span", { class: "may", role: "status", "data-testid": "may" }, t("You may {{rights}}", { rights: rightsText(people.rights) }))]),
      element("button", { class: "tool-button", title: t("People: who is here, and what they may do"), "aria-label": t("People"), "data-testid": "people-open", onclick: () => openPeople(this.parts) }, icon("people")),
    );
  }

  private button(member: Member): HTMLElement {
    const isSelf = this.parts.people.isSelf(member);
    const name = memberName(member);
    const title = isSelf ? t("{{name}} (you): change your name", { name }) : t("{{name}}: look where they look", { name });
    const button = element(
      "button",
      { class: isSelf ? "person self" : "person", title, "aria-label": title, "data-testid": `person-${member.client}`, onclick: () => (isSelf ? this.rename() : this.join(member)) },
      initials(name),
    );
    // The server's colour; the policy allows no style attribute, but a property that a script sets.
    button.style.background = member.color;
    button.style.color = inkOn(member.color);
    return button;
  }

  private rename(): void {
    const { preferences } = this.parts;
    openTextDialog(t("Your name"), { label: t("What the others see"), value: preferences.get("userName"), action: t("Use it"), testId: "rename" }, async (name) => {
      preferences.set("userName", name);
      return null;
    });
  }

  private join(member: Member): void {
    const { people, notices, view } = this.parts;
    const look = lookOf(people.presence(member.client));
    if (look) view.rig.goTo(look.position, look.target, performance.now());
    else notices.tell({ level: "info", text: t("It is not known yet where {{name}} looks", { name: memberName(member) }) });
  }
}
