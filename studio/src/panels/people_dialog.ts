// SPDX-License-Identifier: MIT
import type { Invitation, Member, Rights } from "../connection/messages";
import { memberName, rightsText } from "../document/people";
import type { Parts } from "../parts";
import { icon } from "../tools/icons";
import { inkOn } from "../view/name_tag";
import { openDialog } from "./dialogs";
import { around, element, GAP } from "./element";
import { t } from "../language";

type PeopleParts = Pick<Parts, "server" | "notices" | "people">;

/** What can be chosen for a guest. */
const CHOICES: readonly Pick<Rights, "edit" | "run">[] = [
  { edit: true, run: true },
  { edit: true, run: false },
  { edit: false, run: true },
  { edit: false, run: false },
];

/** Who is here and what each may do; below, addresses for those who may come. */
export function openPeople(parts: PeopleParts): void {
  const list = element("ul", { class: "members", "data-testid": "members" });
  const fill = (): void => list.replaceChildren(...parts.people.members.map((member) => line(parts, member)));
  const end = parts.people.changed.on(fill);
  fill();
  const dialog = openDialog(t("People"), "people-dialog", list, invitations(parts));
  dialog.addEventListener("close", end);
}

function line(parts: PeopleParts, member: Member): HTMLElement {
  const { people } = parts;
  const name = memberName(member);
  const mark = element("span", { class: "member-mark" });
  mark.style.background = member.color;
  mark.style.color = inkOn(member.color);
  const who = people.isSelf(member) ? t("{{name}} (you)", { name }) : name;
  const isFree = people.rights.invite && !member.rights.invite;
  const may = isFree ? choice(parts, member, name) : element("span", { class: "note" }, member.rights.invite ? t("may do everything") : t("may {{rights}}", { rights: rightsText(member.rights) }));
  return element("li", { "data-testid": `member-${member.client}` }, mark, element("span", { class: "member-name" }, who), may);
}

function choice(parts: PeopleParts, member: Member, name: string): HTMLElement {
  const select = element(
    "select",
    {
      "aria-label": t("What {{name}} may do", { name }),
      "data-testid": `rights-${member.client}`,
      onchange: () => void parts.server.command("client.set_rights", { client: member.client, ...CHOICES[Number(select.value)]! }),
    },
    ...CHOICES.map((rights, at) => element("option", { value: at, selected: rights.edit === member.rights.edit && rights.run === member.rights.run }, t("may {{rights}}", { rights: rightsText(rights) }))),
  );
  return select;
}

function invitations({ server, notices, people }: PeopleParts): HTMLElement {
  if (!people.rights.invite) return element("p", { class: "note" }, t("Whoever started Embody can change what you may do, and invite others."));
  if (server.invitations.length === 0)
    return element(
      "div",
      {},
      element("h3", {}, t("Invite")),
      element("p", { class: "note", "data-testid": "invite-how" }, ...around(t("This Studio answers only its own computer. So that others can come, also in a headset, start it with {{command}}.", { command: GAP }), element("code", {}, "embody serve --address 0.0.0.0 --tls"))),
    );
  const copy = async (url: string): Promise<void> => {
    await navigator.clipboard.writeText(url);
    notices.tell({ level: "info", text: t("The address is copied") });
  };
  const address = ({ rights, urls }: Invitation): HTMLElement[] =>
    urls.map((url) => {
      const field = element("input", { type: "text", readonly: true, value: url, "aria-label": t("Address to {{rights}}", { rights: rightsText(rights) }), onfocus: () => field.select() });
      const button = navigator.clipboard && element("button", { "aria-label": t("Copy the address to {{rights}}", { rights: rightsText(rights) }), title: t("Copy"), onclick: () => void copy(url) }, icon("copy"));
      return element("li", { "data-testid": `invite-${rights.edit ? "build" : rights.run ? "run" : "look"}` }, element("span", {}, rights.invite ? t("To do everything") : t("To {{rights}}", { rights: rightsText(rights) })), field, button);
    });
  return element(
    "div",
    {},
    element("h3", {}, t("Invite")),
    element("p", { class: "note" }, t("Whoever has one of these addresses can come as long as this Embody runs. What a guest may do can be changed above.")),
    element("ul", { class: "invitations" }, ...server.invitations.flatMap(address)),
  );
}
