import assert from "node:assert/strict";
import { test } from "node:test";
import { decoded } from "../src/data.js";
import { measured } from "../src/extent.js";

const encoded = (numbers) => Buffer.from(Float32Array.from(numbers).buffer).toString("base64");

// A scene of shapes [kind, count, text], and stills.
function scene(shapes, stills, gravity = [0, 0, 0]) {
  const times = encoded(stills.map((_, n) => n));
  return decoded(JSON.stringify({ shapes, gravity, times, frames: encoded(stills.flat()) }));
}

const rod = (x) => [x, 0, 0, x + 1, 0, 0.5];

test("a motion in a plane is seen at a right angle, with gravity down", () => {
  const swing = measured(scene([["line", 6, ""]], [rod(0), rod(1)], [0, 0, -9.81]));
  assert.deepEqual([swing.flat, swing.right, swing.up, swing.isUpright], [1, [1, 0, 0], [0, 0, 1], true]);
  const slide = measured(scene([["line", 6, ""]], [[0, 0, 0, 1, 0, 0], [1, 0, 0, 1, 1, 0]], [0, 0, -9.81]));
  assert.deepEqual([slide.flat, slide.up, slide.isTop], [2, [0, 0, 1], true]);
  const sheet = measured(scene([["line", 6, ""]], [[0, 0, 0, 1, 0, 0], [1, 0, 0, 1, 1, 0]]));
  assert.deepEqual([sheet.flat, sheet.up, sheet.isUpright], [2, [0, 1, 0], true]);
});

test("up is against gravity, also where that is downwards along an axis", () => {
  const { flat, right, up } = measured(scene([["line", 6, ""]], [[0, 0, 0, 1, 2, 3], [1, 1, 1, 3, 2, 1]], [0, 0, 9.81]));
  assert.deepEqual([flat, right, up], [undefined, [1, 0, 0], [0, 0, -1]]);
});

test("what leans out of the plane is in space", () => {
  const disc = (normal) => scene([["disc", 7, ""]], [[0, 0, 0, ...normal, 1], [1, 0, 0, ...normal, 1]]);
  assert.deepEqual([[0, 0, 1], [0, 1, 0], [1, 0, 0]].map((normal) => measured(disc(normal)).flat), [2, 1, undefined]);
});

test("a long path is followed, and the size is that of the model", () => {
  const far = measured(scene([["line", 6, ""]], [rod(0), rod(2), rod(9)]));
  assert.deepEqual([far.follows, far.size], [true, 1]);
  const near = measured(scene([["line", 6, ""]], [rod(0), rod(2)]));
  assert.deepEqual([near.follows, near.size], [false, 3]);
  const ball = measured(scene([["sphere", 4, ""]], [[0, 0, 0, 0.5], [9, 0, 0, 0.5]]));
  assert.deepEqual([ball.follows, ball.size], [false, 10]);
});

test("a disc reaches as far as it leans, so that it touches the ground", () => {
  const lean = [0, Math.SQRT1_2, Math.SQRT1_2];
  const { low } = measured(scene([["disc", 7, ""]], [[0, 0, Math.SQRT1_2, ...lean, 1]], [0, 0, -1]));
  assert.ok(Math.abs(low[2]) < 1e-6, `${low[2]}`);
});

test("numbers that are not known say nothing of the size", () => {
  const { size, middle } = measured(scene([["point", 3, ""]], [[NaN, NaN, NaN], [0, 0, 0], [2, 0, 0]]));
  assert.deepEqual([size, middle], [2, [1, 0, 0]]);
  assert.equal(measured(scene([["point", 3, ""]], [[NaN, NaN, NaN]])).size, 1);
});

test("a view that follows goes on to do so, and one that does not, while a motion changes little by little", () => {
  const path = (length) => scene([["line", 6, ""]], [rod(0), rod(length)]);
  assert.deepEqual([3, 5].map((length) => measured(path(length)).follows), [false, true]);
  assert.deepEqual([3, 1.2, 0.1].map((length) => measured(path(length), true).follows), [true, true, false]);
  assert.deepEqual([5, 10, 20].map((length) => measured(path(length), false).follows), [false, false, true]);
});
