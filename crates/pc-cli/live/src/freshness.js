// Which parts of the page belong to the latest text. What is older stays, and is dimmed after a while.

const PATIENCE = 400;

export class Freshness {
  // `mark` is told a part and whether it is old.
  constructor(mark, wait = (go, ms) => setTimeout(go, ms)) {
    Object.assign(this, { mark, wait, latest: 0, shown: new Map() });
  }

  // Parts are expected from the request with this number.
  expect(parts, id) {
    this.latest = id;
    parts.forEach((part) => this.shown.has(part) || this.shown.set(part, 0));
    this.wait(() => parts.forEach((part) => this.mark(part, this.shown.get(part) < id)), PATIENCE);
  }

  // Whether a part shows nothing newer yet.
  isNews(part, id) {
    return id >= (this.shown.get(part) ?? 0);
  }

  got(part, id) {
    this.shown.set(part, Math.max(id, this.shown.get(part) ?? 0));
    this.mark(part, false);
  }
}
