import assert from "node:assert/strict";
import { test } from "node:test";
import { Pose } from "../src/pose.js";

// Rows of the rotation about the third axis.
const turned = (angle) => [Math.cos(angle), -Math.sin(angle), 0, Math.sin(angle), Math.cos(angle), 0, 0, 0, 1];

test("a still is shown with its own numbers; between stills what turns stays a rotation", () => {
  const stills = Float32Array.from([0, 0, 0, ...turned(0.2), 1, 2, 3, ...turned(1.4)]);
  const pose = new Pose({ shapes: [{ kind: "axes", at: 0, count: 12 }], width: 12, times: [0, 1], stills });
  pose.set(1);
  assert.deepEqual(pose.numbers, stills.subarray(12));
  pose.set(0.5);
  const wanted = [0.5, 1, 1.5, ...turned(0.8)];
  pose.numbers.forEach((x, i) => assert.ok(Math.abs(x - wanted[i]) < 1e-6, `${i}: ${x}`));
});
