// SPDX-License-Identifier: MIT
import type { Asked, Question } from "../connection/messages";
import { Signal } from "../signal";

/** Opening another scene while several people are here: the others are asked first, and all wait for their answers. */
export class Opening {
  readonly changed = new Signal<void>();
  /** Somebody asks this page; `until` is on the page's clock, ms. */
  question: (Question & { until: number }) | null = null;
  /** This page has asked others. */
  waiting: { question: number; asked: readonly number[]; until: number } | null = null;

  ask(question: Question): void {
    this.question = { ...question, until: performance.now() + 1000 * question.seconds };
    this.changed.emit();
  }

  /** Takes the answer to scene.load or scene.new: whether others were asked. */
  wait({ question, asked = [], seconds = 0 }: Asked): void {
    if (question === undefined) return;
    this.waiting = { question, asked, until: performance.now() + 1000 * seconds };
    this.changed.emit();
  }

  /** The question was answered, or its time is over. */
  end(question: number): void {
    if (this.question?.question === question) this.question = null;
    if (this.waiting?.question === question) this.waiting = null;
    this.changed.emit();
  }

  /** The connection was lost, and with it all questions. */
  forget(): void {
    this.question = this.waiting = null;
    this.changed.emit();
  }
}
