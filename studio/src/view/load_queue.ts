// SPDX-License-Identifier: MIT

interface Job {
  /** Larger is sooner; asked anew for each choice, since the camera moves. */
  urgency: () => number;
  run: () => Promise<void>;
}

/** Work of which only so much goes on at once, the most urgent first. */
export class LoadQueue {
  private readonly jobs: Job[] = [];
  private running = 0;

  constructor(private readonly most: number) {}

  /** Does the work when its turn comes; settles as it does. */
  add<Value>(urgency: () => number, work: () => Promise<Value>): Promise<Value> {
    return new Promise((resolve, reject) => {
      this.jobs.push({ urgency, run: () => work().then(resolve, reject) });
      // Whoever asks next in the same turn may be more urgent.
      queueMicrotask(() => this.start());
    });
  }

  private start(): void {
    while (this.running < this.most && this.jobs.length > 0) {
      const urgencies = this.jobs.map(({ urgency }) => urgency());
      const [job] = this.jobs.splice(urgencies.indexOf(Math.max(...urgencies)), 1);
      ++this.running;
      void job!.run().finally(() => {
        --this.running;
        this.start();
      });
    }
  }
}
