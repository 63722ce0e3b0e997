import assert from "node:assert/strict";
import { test } from "node:test";
import { roundBelow, roundNumbers, written } from "../src/numbers.js";

test("round numbers are 1, 2 and 5 times powers of ten", () => {
  assert.deepEqual(roundNumbers(0.1, 20), [0.1, 0.2, 0.5, 1, 2, 5, 10, 20]);
  assert.deepEqual(roundNumbers(3, 4), []);
  assert.equal(roundBelow(4.99), 2);
  assert.equal(roundBelow(1e-7), 1e-7);
});

test("numbers are written without digits that say nothing", () => {
  assert.deepEqual([0.1 + 0.2, 20000, 1e6, 5e-7].map(written), ["0.3", "20000", "1e6", "5e-7"]);
});
