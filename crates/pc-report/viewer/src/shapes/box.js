// A box, with faces through which other shapes are seen, and strong edges.

import { BackSide, BoxGeometry, FrontSide, Group, Mesh } from "three";
import { rotation } from "../pose.js";
import { ofCurve, surface } from "./material.js";
import { Rods } from "./rod.js";

const CUBE = new BoxGeometry(1, 1, 1);
const EDGE = 0.004;
const OPACITY = 0.5;

// The edges as pairs of corners, whose bits select ends of the edge lengths.
const EDGES = [0, 1, 2].flatMap((k) =>
  [0, 1, 2, 3, 4, 5, 6, 7].filter((bits) => !(bits & (1 << k))).map((bits) => [bits, bits | (1 << k)]),
);

export class Box {
  constructor(shape, size) {
    this.group = new Group();
    this.group.matrixAutoUpdate = false;
    // The far faces first.
    this.faces = [BackSide, FrontSide].map((side, order) => {
      const material = surface(ofCurve(shape.hue), { transparent: true, opacity: OPACITY, side, depthWrite: false });
      const mesh = new Mesh(CUBE, material);
      mesh.renderOrder = order;
      return mesh;
    });
    const material = surface(ofCurve(shape.hue));
    this.edges = EDGES.map(() => new Rods(2, EDGE * size, material));
    this.group.add(...this.faces, ...this.edges.map((edge) => edge.group));
  }

  update(numbers, i) {
    rotation(this.group.matrix, numbers, i + 6).setPosition(numbers[i], numbers[i + 1], numbers[i + 2]);
    const lengths = [numbers[i + 3], numbers[i + 4], numbers[i + 5]];
    this.faces.forEach((mesh) => mesh.scale.set(...lengths.map((length) => Math.abs(length) || 1e-9)));
    const corner = (bits) => lengths.map((length, k) => (((bits >> k) & 1) - 0.5) * length);
    EDGES.forEach((ends, n) => this.edges[n].update(ends.flatMap(corner), 0));
  }
}
