import assert from "node:assert/strict";
import { test } from "node:test";
import { decoded } from "../src/data.js";
import { measured } from "../src/extent.js";
import { longest } from "../src/quantities.js";

const encoded = (numbers) => Buffer.from(Float32Array.from(numbers).buffer).toString("base64");

// A point with two vectors: the second is zero all the time, and the first not known at the end.
const data = decoded({
  shapes: [["point", 3, "bob"]],
  arrows: [["velocity", "bob", 0, 3], ["force", "bob", 0, 6]],
  width: 9,
  times: encoded([0, 1, 2]),
  frames: encoded([0, 0, 0, 3, 4, 0, 0, 0, 0, 1, 0, 0, 0, 0, -2, 0, 0, 0, 2, 0, 0, NaN, 0, 0, 0, 0, 0]),
  gravity: [0, -9.81, 0],
  up: [1, 0, 0],
});

test("the longest vector of each quantity is found over the motion; what is zero is not offered", () => {
  assert.deepEqual([...longest(data)], [["velocity", 5]]);
});

test("arrows say nothing of the size of the model, and the text says which way is up", () => {
  const { size, up } = measured(data);
  assert.deepEqual([size, up], [2, [1, 0, 0]]);
});

test("a page without arrows has none", () => {
  const plain = decoded({ shapes: [["point", 3, ""]], times: encoded([0]), frames: encoded([0, 0, 0]), gravity: [0, 0, 0] });
  assert.deepEqual([plain.arrows, plain.width, plain.down], [[], 3, [0, 0, 0]]);
});
