// SPDX-License-Identifier: MIT
import { Signal } from "../signal";
import type { Connection } from "./connection";
import type { CatalogEvent, Commands, Hello, Invitation, LibraryFill, Progress } from "./messages";
import type { Notices } from "./notices";

/** The server as panels and tools see it: its commands, its version, and events that are not about the scene. */
export class Server {
  /** Connected, disconnected, or greeted. */
  readonly changed = new Signal<void>();
  /** Models were changed by hand, in this page or elsewhere. */
  readonly catalogChanged = new Signal<CatalogEvent>();
  /** Progress of the command that is being executed, this page's or another's; all other commands wait for it. */
  readonly progress = new Signal<Progress>();
  /** The server imports models by itself: how far it is. */
  readonly filling = new Signal<LibraryFill>();
  /** The last of these; null before the first. */
  fill: LibraryFill | null = null;
  version = "";
  /** Addresses for guests; empty where there are none, or this page may not invite. */
  invitations: readonly Invitation[] = [];
  /** This page's number on the server. */
  client = 0;
  /** Whether the document has arrived: false until the first answer to hello. */
  ready = false;

  constructor(
    private readonly connection: Connection,
    private readonly notices: Notices,
  ) {}

  get isOpen(): boolean {
    return this.connection.isOpen;
  }

  get opened(): Signal<void> {
    return this.connection.opened;
  }

  /** The full address of one of the server's paths. */
  address(path: string): string {
    return this.connection.address(path);
  }

  /** Sends a command; rejects with CommandRefused or NotConnected. */
  request<Name extends keyof Commands>(name: Name, params: Commands[Name][0]): Promise<Commands[Name][1]> {
    return this.connection.request(name, params);
  }

  /** Sends a command; a refusal is shown to the user, and the result is undefined. */
  async command<Name extends keyof Commands>(name: Name, params: Commands[Name][0]): Promise<Commands[Name][1] | undefined> {
    try {
      return await this.request(name, params);
    } catch (error) {
      this.notices.report(error as Error);
      return undefined;
    }
  }

  takeFill(fill: LibraryFill): void {
    this.fill = fill;
    this.filling.emit(fill);
  }

  /** Takes the answer to hello: the server's version, this page's number, and what the server is importing. */
  meet({ version, client, import: fill, server }: Hello): void {
    this.version = version;
    this.invitations = server?.invitations ?? [];
    this.client = client;
    this.ready = true;
    this.fill = fill ?? null;
    if (fill) this.filling.emit(fill);
  }
}
