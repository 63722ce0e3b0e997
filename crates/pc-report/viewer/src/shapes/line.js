// A line: rods from corner to corner.

import { Rods } from "./rod.js";
import { ofRods, surface } from "./material.js";

const RADIUS = 0.0095;

export class Line {
  constructor(shape, size) {
    this.rods = new Rods(shape.count / 3, RADIUS * size, surface(ofRods));
    this.group = this.rods.group;
  }

  update(numbers, i) {
    this.rods.update(numbers, i);
  }
}
