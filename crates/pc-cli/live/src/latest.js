// Work of which only the latest counts.

// Starts work at once and aborts what was at work before. `work` takes a job and an AbortSignal.
export class Newest {
  constructor(work) {
    this.work = work;
  }

  async start(job) {
    this.abort();
    const control = new AbortController();
    this.control = control;
    try {
      await this.work(job, control.signal);
    } finally {
      if (this.control === control) {
        this.control = undefined;
      }
    }
  }

  get isBusy() {
    return this.control !== undefined;
  }

  abort() {
    this.control?.abort();
    this.control = undefined;
  }
}

// Does one job at a time, not more often than every `pause` milliseconds; of those that wait, only the last.
export class Latest {
  constructor(work, pause = 0, clock = { now: () => performance.now(), wait: (ms) => new Promise((go) => setTimeout(go, ms)) }) {
    Object.assign(this, { work, pause, clock, isBusy: false, waiting: undefined });
  }

  async offer(job) {
    this.waiting = { job };
    if (this.isBusy) {
      return;
    }
    this.isBusy = true;
    try {
      while (this.waiting) {
        const { job: next } = this.waiting;
        this.waiting = undefined;
        const start = this.clock.now();
        await this.work(next);
        const rest = this.pause - (this.clock.now() - start);
        if (rest > 0) {
          await this.clock.wait(rest);
        }
      }
    } finally {
      this.isBusy = false;
    }
  }

  // Forgets what waits.
  clear() {
    this.waiting = undefined;
  }
}
