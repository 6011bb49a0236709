// SPDX-License-Identifier: MIT
import { Signal } from "../signal";
import { CommandRefused, NotConnected } from "./connection";
import type { ServerError } from "./messages";
import { t, translatedWord, translateServerText } from "../language";

export interface Notice {
  level: "info" | "warning" | "error";
  text: string;
  remedy?: string;
  /** A button of the message. */
  action?: { label: string; run: () => void };
}

/** What the user is told. */
export class Notices {
  readonly told = new Signal<Notice>();

  tell(notice: Notice): void {
    this.told.emit(notice);
  }

  /** Shows why something failed and what to do. */
  report(error: Error): void {
    if (error instanceof CommandRefused) this.tell(noticeOf(error.error));
    else if (error instanceof NotConnected)
      this.tell({ level: "error", text: t("Not connected to the server"), remedy: t("Your change was not carried out; try again once connected.") });
    else this.tell({ level: "error", text: error.message });
  }
}

function noticeOf(error: ServerError): Notice {
  const text = error.where ? `${translatedWord(error.where)}: ${translateServerText(error.why)}` : translateServerText(error.why);
  return { level: "error", text, remedy: translateServerText(error.remedy) };
}
