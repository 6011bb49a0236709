// SPDX-License-Identifier: MIT
import type { Member, Presence, Rights } from "../connection/messages";
import { Signal } from "../signal";
import { t } from "../language";

/** A page that the server has not greeted yet sends nothing; it need not look as if it might not. */
const ALL: Rights = { edit: true, run: true, invite: true };

/** Who is in the session, and what each one looks at, points at, selects and holds. Never part of the document. */
export class People {
  /** Somebody came, went, or is called otherwise. */
  readonly changed = new Signal<void>();
  /** This member's presence has changed. */
  readonly moved = new Signal<number>();
  /** This page's own presence has changed. */
  readonly ownMoved = new Signal<void>();
  /** This page's own presence; put() changes it. */
  readonly own: Presence = {};
  private here: readonly Member[] = [];
  private readonly presences = new Map<number, Presence>();
  private client = 0;

  /** Everybody, this page too. */
  get members(): readonly Member[] {
    return this.here;
  }

  get others(): readonly Member[] {
    return this.here.filter(({ client }) => client !== this.client);
  }

  /** What this page may do. */
  get rights(): Rights {
    return this.member(this.client)?.rights ?? ALL;
  }

  isSelf({ client }: Member): boolean {
    return client === this.client;
  }

  member(client: number): Member | undefined {
    return this.here.find((each) => each.client === client);
  }

  presence(client: number): Presence {
    return this.presences.get(client) ?? {};
  }

  /** Sets who is here; `client` is this page's own number. */
  meet(members: readonly Member[], client = this.client): void {
    this.here = members;
    this.client = client;
    for (const each of [...this.presences.keys()]) if (!this.member(each)) this.presences.delete(each);
    this.changed.emit();
  }

  /** Takes the news of another member; what they do not mention is as it was. */
  take(client: number, news: Presence): void {
    if (client === this.client) return;
    this.presences.set(client, { ...this.presences.get(client), ...news });
    this.moved.emit(client);
  }

  /** Changes this page's own presence. Headset and page write here; it is sent as often as the session allows. */
  put(part: Presence): void {
    Object.assign(this.own, part);
    this.ownMoved.emit();
  }
}

/** The name to show for a member. */
export function memberName({ name, client }: Member): string {
  return name || t("Guest {{client}}", { client });
}

/** For people: what somebody with these rights may do. */
export function rightsText({ edit, run }: Pick<Rights, "edit" | "run">): string {
  if (edit && run) return t("build and play");
  if (edit) return t("build, not play");
  return run ? t("look and play") : t("look");
}

/** One or two letters for a name: Ann → A, Ben Smith → BS, Guest 3 → G3. */
export function initials(name: string): string {
  const words = name.split(/\s+/).filter(Boolean);
  const last = words.length > 1 ? words.at(-1)! : "";
  return `${[...(words[0] ?? "?")][0]}${[...last][0] ?? ""}`.toUpperCase();
}
