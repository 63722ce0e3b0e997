// A point: a small ball, larger if it has a label.

import { Mesh, SphereGeometry } from "three";
import { ofCurve, surface } from "./material.js";

const BALL = new SphereGeometry(1, 32, 20);
const [LARGE, SMALL] = [0.021, 0.014];

// The radius with which a point is drawn, in units of the size of the model.
export function radiusOf(shape) {
  return shape.text ? LARGE : SMALL;
}

export class Point {
  constructor(shape, size) {
    this.group = new Mesh(BALL, surface(ofCurve(shape.hue)));
    this.group.scale.setScalar(radiusOf(shape) * size);
  }

  update(numbers, i) {
    this.group.position.fromArray(numbers, i);
  }
}
