import assert from "node:assert/strict";
import { test } from "node:test";
import { Clock, defaultSpeed } from "../src/clock.js";

test("a motion lasts 5 to 20 seconds at first", () => {
  for (const duration of [1e-6, 0.26, 1, 3, 4.9, 21, 40, 86400, 1e9]) {
    const seconds = duration / defaultSpeed(duration);
    assert.ok(seconds >= 5 && seconds <= 20, `${duration}: ${seconds}`);
  }
  assert.deepEqual([5, 12, 20, 0].map(defaultSpeed), [1, 1, 1, 1]);
});

test("a still is shown exactly, and between stills the time goes on evenly", () => {
  const clock = new Clock([0, 1, 3, 13]);
  clock.show(2);
  assert.equal(clock.position(), 2);
  clock.show(1);
  clock.advance(1);
  assert.equal(clock.position(), 1.5);
  clock.advance(2);
  assert.equal(clock.position(), 2.1);
});

test("at the end the motion repeats, or stops", () => {
  const clock = new Clock([0, 5, 10]);
  clock.start();
  clock.advance(11);
  assert.deepEqual([clock.position(), clock.isPlaying], [0, true]);
  clock.loops = false;
  clock.advance(11);
  assert.deepEqual([clock.position(), clock.isPlaying], [2, false]);
  clock.start();
  assert.deepEqual([clock.position(), clock.isPlaying], [0, true]);
});

test("time may run backwards, and may not run at all", () => {
  const back = new Clock([10, 5, 0]);
  back.advance(7.5);
  assert.equal(back.position(), 1.5);
  const one = new Clock([3]);
  one.start();
  assert.deepEqual([one.position(), one.isPlaying], [0, false]);
});

test("a time is gone to between two stills, and not beyond the ends", () => {
  const clock = new Clock(Float32Array.from([0, 1, 2, 4]));
  for (const [time, still, now] of [[1.5, 1, 1.5], [3, 2, 3], [0, 0, 0], [9, 3, 4], [-1, 0, 0]]) {
    clock.seek(time);
    assert.deepEqual([clock.still, clock.now], [still, now]);
  }
  const back = new Clock(Float32Array.from([0, -1, -2]));
  back.seek(-1.5);
  assert.deepEqual([back.still, back.now, back.position()], [1, -1.5, 1.5]);
});

test("another motion goes on at the same time", () => {
  const clock = new Clock([0, 5, 10]);
  clock.seek(7);
  clock.isPlaying = true;
  clock.replace([0, 2, 4, 6, 8, 10, 12]);
  assert.equal(clock.now, 7);
  assert.equal(clock.still, 3);
  assert.ok(clock.isPlaying);
  clock.replace([0, 1, 2]);
  assert.equal(clock.now, 2);
  // A speed that was chosen stays; the other fits the motion.
  assert.equal(clock.speed, defaultSpeed(2));
  clock.speed = 3;
  clock.replace([0, 100]);
  assert.equal(clock.speed, 3);
});
