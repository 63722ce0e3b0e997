import assert from "node:assert/strict";
import { test } from "node:test";
import { Freshness } from "../src/freshness.js";
import { Latest, Newest } from "../src/latest.js";

const turn = () => new Promise((go) => setImmediate(go));

test("of jobs that wait, only the last is done", async () => {
  const [done, ends] = [[], []];
  const latest = new Latest((job) => new Promise((end) => { done.push(job); ends.push(end); }));
  const all = latest.offer(1);
  latest.offer(2);
  latest.offer(3);
  assert.deepEqual(done, [1]);
  ends[0]();
  await turn();
  assert.deepEqual(done, [1, 3]);
  ends[1]();
  await all;
  assert.equal(latest.isBusy, false);
});

test("jobs keep a pause between their starts", async () => {
  const waits = [];
  let now = 0;
  const clock = { now: () => now, wait: async (ms) => { waits.push(ms); now += ms; } };
  const latest = new Latest(async () => { now += 10; }, 33, clock);
  const all = latest.offer(1);
  latest.offer(2);
  await all;
  assert.deepEqual(waits, [23, 23]);
});

test("a job that fails does not stop later ones", async () => {
  const latest = new Latest(async (job) => { if (job === 1) { throw new Error("no"); } });
  await assert.rejects(latest.offer(1));
  await latest.offer(2);
  assert.equal(latest.isBusy, false);
});

test("newer work aborts older work", async () => {
  const signals = [];
  const ends = [];
  const newest = new Newest((_job, signal) => new Promise((end) => { signals.push(signal); ends.push(end); }));
  const first = newest.start(1);
  const second = newest.start(2);
  assert.deepEqual(signals.map(({ aborted }) => aborted), [true, false]);
  ends[0]();
  await first;
  assert.ok(newest.isBusy);
  ends[1]();
  await second;
  assert.ok(!newest.isBusy);
});

test("parts are dimmed if nothing newer has come in time", () => {
  const old = new Map();
  const timers = [];
  const freshness = new Freshness((part, isOld) => old.set(part, isOld), (go) => timers.push(go));
  freshness.expect(["plots", "equations"], 1);
  freshness.got("plots", 1);
  timers.shift()();
  assert.deepEqual([...old], [["plots", false], ["equations", true]]);
  freshness.got("equations", 1);
  assert.equal(old.get("equations"), false);
  assert.ok(!freshness.isNews("plots", 0) && freshness.isNews("plots", 1) && freshness.isNews("plots", 2));
});
