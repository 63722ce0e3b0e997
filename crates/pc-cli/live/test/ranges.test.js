import assert from "node:assert/strict";
import { test } from "node:test";
import { duration, read, roundAbove, written } from "../src/numbers.js";
import { partOf, rangeOf, stepped, widened } from "../src/ranges.js";

test("what is positive stays so, and starts go both ways", () => {
  assert.deepEqual(rangeOf(10), { low: 0, high: 20, step: 0.1 });
  assert.deepEqual(rangeOf(-0.3), { low: -0.6, high: 0, step: 0.005 });
  assert.deepEqual(rangeOf(0), { low: -1, high: 1, step: 0.01 });
  assert.deepEqual(rangeOf(1.2, true), { low: -0.8, high: 3.2, step: 0.02 });
  assert.deepEqual(rangeOf(0, true), { low: -1, high: 1, step: 0.01 });
});

test("a typed value outside widens the range", () => {
  const range = rangeOf(10);
  assert.equal(widened(range, 15), range);
  assert.deepEqual(widened(range, 100), { low: 0, high: 120, step: 1 });
  assert.deepEqual(widened(range, -5), { low: -6, high: 20, step: 0.2 });
});

test("slid values are round, and the ends are among them", () => {
  const range = rangeOf(9.81);
  assert.equal(stepped(range, 9.77), 9.8);
  assert.equal(stepped(range, 25), 19.62);
  assert.equal(stepped(range, 0.30000000000000004), 0.3);
  assert.equal(stepped(range, -1), 0);
  assert.equal(partOf(range, 9.81), 0.5);
});

test("numbers are read and written", () => {
  assert.equal(read(" 1,5 "), 1.5);
  assert.equal(read("−2e-3"), -0.002);
  assert.equal(read("x"), undefined);
  assert.equal(read(""), undefined);
  assert.equal(written(0.1 + 0.2), "0.3");
  assert.equal(written(1e-7), "1e-7");
  assert.equal(written(6.02e23), "6.02e23");
  assert.equal(roundAbove(0.0981), 0.1);
  assert.equal(roundAbove(2), 2);
  assert.equal(duration(12.4), "12 ms");
  assert.equal(duration(2400), "2.4 s");
});
