import assert from "node:assert/strict";
import { test } from "node:test";
import { decoded, reachOf } from "../src/data.js";

// Numbers in IEEE 754 single precision, least significant byte first, encoded in base 64.
const packed = (numbers) => Buffer.from(Float32Array.from(numbers).buffer).toString("base64");

// A triangle, turned by a right angle about the third axis, which lies at 1, 2, 3.
const turned = [0, -1, 0, 1, 0, 0, 0, 0, 1];
const source = {
  shapes: [["point", 3, "tip"], ["mesh", 12, "0"]],
  meshes: [{ corners: packed([-2, 0, 0, 2, 0, 0, 0, 1, 0.5]), faces: packed([0, 1, 2]) }],
  gravity: [0, 0, -1],
  width: 15,
  times: packed([0]),
  frames: packed([0, 0, 0, 1, 2, 3, ...turned]),
};

test("a mesh has its corners and faces, and a colour of its own", () => {
  const { shapes, stills } = decoded(JSON.stringify(source));
  const { mesh, hue, at } = shapes[1];
  assert.deepEqual([...mesh.faces], [0, 1, 2]);
  assert.deepEqual([...mesh.corners.slice(6)], [0, 1, 0.5]);
  assert.equal(hue, 1);
  assert.deepEqual([...stills.subarray(at, at + 3)], [1, 2, 3]);
});

test("a mesh reaches along the fixed axes as it is turned", () => {
  const { shapes, stills } = decoded(source);
  assert.deepEqual(reachOf(shapes[1], stills), [1, 2, 0.5]);
});
