// SPDX-License-Identifier: MIT
import { Signal } from "../signal";
import type { DebugFrame } from "./debug_frame";
import type { Frame } from "./frame";
import type { Commands, ServerError, ServerEvent } from "./messages";
import type { FromWorker, ToWorker } from "./socket_worker";
import { t, translateServerText } from "../language";

/** A command that the server refused; `where`, `why` and `remedy` are for the user. */
export class CommandRefused extends Error {
  constructor(readonly error: ServerError) {
    super(error.why);
  }
}

/** The command was not carried out because there is no connection. */
export class NotConnected extends Error {
  constructor() {
    super(t("The server cannot be reached."));
  }
}

/** Why something failed and what to do, in a line. */
export function reasonText(error: Error): string {
  if (!(error instanceof CommandRefused)) return error.message;
  const { why, remedy } = error.error;
  const told = translateServerText(why);
  return remedy ? t("{{why}}. {{remedy}}", { why: told, remedy: translateServerText(remedy) }) : told;
}

/** So many commands are under way at most; the others wait here, in order, so that hundreds at once flood neither socket nor server. */
const MOST_UNDER_WAY = 64;

type Waiting = { resolve: (result: never) => void; reject: (error: Error) => void };

/** The page's side of the socket worker: commands as promises, events and frames as signals; it reconnects without end. */
export class Connection {
  readonly opened = new Signal<void>();
  readonly closed = new Signal<string>();
  readonly event = new Signal<ServerEvent>();
  readonly frame = new Signal<Frame>();
  /** Debug frames, as chosen by debug.draw. */
  readonly debug = new Signal<DebugFrame>();
  /** Something arrived that this version of the Studio cannot read. */
  readonly fault = new Signal<string>();
  isOpen = false;

  private readonly worker = new Worker(new URL("./socket_worker.ts", import.meta.url), { type: "module" });
  private readonly waiting = new Map<number, Waiting>();
  private readonly queue: string[] = [];
  private nextId = 1;
  /** Sent with every request to a server that listens on more than this machine. */
  private readonly token = new URLSearchParams(location.search).get("token");

  open(): void {
    this.worker.onmessage = (event: MessageEvent<FromWorker>) => this.receive(event.data);
    const address = new URL(this.address("ws"));
    address.protocol = address.protocol === "https:" ? "wss:" : "ws:";
    this.tell({ kind: "open", url: address.href });
  }

  /** The full address of one of the server's paths, with the token where there is one. */
  address(path: string): string {
    const address = new URL(path, location.href);
    if (this.token) address.searchParams.set("token", this.token);
    return address.href;
  }

  /** Sends a command; rejects with CommandRefused or NotConnected. */
  request<Name extends keyof Commands>(command: Name, params: Commands[Name][0]): Promise<Commands[Name][1]> {
    if (!this.isOpen) return Promise.reject(new NotConnected());
    const id = this.nextId++;
    return new Promise((resolve, reject) => {
      this.waiting.set(id, { resolve, reject } as Waiting);
      this.queue.push(JSON.stringify({ id, command, params }));
      this.sendQueued();
    });
  }

  private sendQueued(): void {
    const free = MOST_UNDER_WAY - (this.waiting.size - this.queue.length);
    for (const text of this.queue.splice(0, Math.max(0, free))) this.tell({ kind: "send", text });
  }

  /** Call when the last frame has been used: the worker may send the next. */
  wantFrame(): void {
    this.tell({ kind: "next_frame" });
  }

  private tell(message: ToWorker): void {
    this.worker.postMessage(message);
  }

  private receive(message: FromWorker): void {
    switch (message.kind) {
      case "opened":
        this.isOpen = true;
        this.opened.emit();
        break;
      case "closed":
        // A try that failed while there is no connection is no news.
        if (!this.isOpen) break;
        this.isOpen = false;
        for (const { reject } of this.waiting.values()) reject(new NotConnected());
        this.waiting.clear();
        this.queue.length = 0;
        this.closed.emit(message.reason);
        break;
      case "text":
        this.receiveText(message.text);
        break;
      case "frame":
        this.frame.emit(message.frame);
        break;
      case "debug":
        this.debug.emit(message.frame);
        break;
      case "fault":
        this.fault.emit(message.reason);
        break;
    }
  }

  private receiveText(text: string): void {
    const message = JSON.parse(text) as { id?: number; ok?: boolean; result?: never; error?: ServerError } & Partial<ServerEvent>;
    if (message.event !== undefined) {
      this.event.emit(message as ServerEvent);
      return;
    }
    const waiting = this.waiting.get(message.id ?? 0);
    this.waiting.delete(message.id ?? 0);
    this.sendQueued();
    if (message.ok) waiting?.resolve(message.result!);
    else waiting?.reject(new CommandRefused(message.error ?? { where: "", why: t("The server gave no reason."), remedy: "" }));
  }
}
