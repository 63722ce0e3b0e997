// The axes of a body: three arrows.

import { ConeGeometry, CylinderGeometry, Group, Mesh } from "three";
import { AXES } from "../axes.js";
import { rotation } from "../pose.js";
import { ofCurve, surface } from "./material.js";

const LENGTH = 0.14;
const SHAFT = new CylinderGeometry(0.03, 0.03, 0.78, 16).translate(0, 0.39, 0);
const HEAD = new ConeGeometry(0.085, 0.25, 24).translate(0, 0.875, 0);
// The angles that turn the second axis into each of the three.
const TURNS = [[0, 0, -Math.PI / 2], [0, 0, 0], [Math.PI / 2, 0, 0]];

export class Axes {
  constructor(_, size) {
    this.group = new Group();
    this.group.matrixAutoUpdate = false;
    AXES.forEach(({ hue }, k) => {
      const material = surface(ofCurve(hue));
      const arrow = new Group();
      arrow.add(new Mesh(SHAFT, material), new Mesh(HEAD, material));
      arrow.rotation.set(...TURNS[k]);
      arrow.scale.setScalar(LENGTH * size);
      this.group.add(arrow);
    });
  }

  update(numbers, i) {
    rotation(this.group.matrix, numbers, i + 3).setPosition(numbers[i], numbers[i + 1], numbers[i + 2]);
  }
}
