import assert from "node:assert/strict";
import { test } from "node:test";
import { Vector3 } from "three";
import { Viewpoint } from "../src/camera.js";

test("a view stays in the space of the model when its unit changes", () => {
  const viewpoint = new Viewpoint(true);
  viewpoint.offset.set(1, 2, 3);
  viewpoint.distance = 4;
  viewpoint.go({ yaw: 1, distance: 6 });
  viewpoint.keep(0.5, new Vector3(1, 0, 0));
  assert.deepEqual(viewpoint.offset.toArray(), [1.5, 1, 1.5]);
  assert.equal(viewpoint.distance, 3);
  assert.equal(viewpoint.yaw, 1);
});
