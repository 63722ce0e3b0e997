// A sphere. Nothing is known of how it turns, so it has no marks.

import { Mesh, SphereGeometry } from "three";
import { ofCurve, surface } from "./material.js";

const BALL = new SphereGeometry(1, 48, 32);
const LEAST = 1e-3;

export class Sphere {
  constructor(shape, size) {
    this.group = new Mesh(BALL, surface(ofCurve(shape.hue)));
    this.least = LEAST * size;
  }

  update(numbers, i) {
    this.group.position.fromArray(numbers, i);
    this.group.scale.setScalar(Math.max(Math.abs(numbers[i + 3]), this.least));
  }
}
