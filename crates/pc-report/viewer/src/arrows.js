// Arrows: vectors along the fixed axes, off at first. Those of one quantity have one scale: the longest over the motion
// is a fixed part of the model.

import { ConeGeometry, CylinderGeometry, Group, Mesh, Vector3 } from "three";
import { longest, QUANTITIES } from "./quantities.js";
import { colour, ofCurve, surface } from "./shapes/material.js";

// Lengths and radii in units of the size of the model.
const LONGEST = 0.3;
const SHAFT_RADIUS = 0.006;
const HEAD_RADIUS = 0.02;
const HEAD = 0.055;
// The largest part of an arrow that its head takes up, and the part of an arrow below which it is not drawn.
const MOST_HEAD = 0.6;
const LEAST = 1e-4;
// After all shapes.
const OVER = 10;
const UP = new Vector3(0, 1, 0);
const SHAFT = new CylinderGeometry(1, 1, 1, 16).translate(0, 0.5, 0);
const CONE = new ConeGeometry(1, 1, 24).translate(0, 0.5, 0);

export class Arrows {
  constructor(data, size) {
    this.size = size;
    this.longest = longest(data);
    this.group = new Group();
    const known = data.arrows.filter(({ quantity }) => this.longest.has(quantity));
    this.list = known.map((arrow) => {
      // Seen through bodies, in which most of them begin.
      const material = surface(ofCurve(QUANTITIES[arrow.quantity].hue), { transparent: true, depthTest: false });
      const [group, shaft, head] = [new Group(), new Mesh(SHAFT, material), new Mesh(CONE, material)];
      [shaft.renderOrder, head.renderOrder] = [OVER, OVER + 1];
      group.add(shaft, head);
      this.group.add(group);
      return { ...arrow, group, shaft, head };
    });
    this.group.traverse((object) => (object.castShadow = Boolean(object.isMesh)));
    this.way = new Vector3();
  }

  // The length in space of a vector of length 1.
  scale(quantity) {
    return (LONGEST * this.size) / this.longest.get(quantity);
  }

  colour(theme) {
    colour(this.group, theme);
  }

  // Shows the arrows of some quantities.
  update(numbers, shown) {
    const { way, size } = this;
    for (const { quantity, at, vector, group, shaft, head } of this.list) {
      way.fromArray(numbers, vector).multiplyScalar(this.scale(quantity));
      const length = way.length();
      group.position.fromArray(numbers, at);
      group.visible = shown.has(quantity) && length > LEAST * size && Number.isFinite(length + group.position.lengthSq());
      if (group.visible) {
        group.quaternion.setFromUnitVectors(UP, way.divideScalar(length));
        const tip = Math.min(HEAD * size, MOST_HEAD * length);
        const width = (HEAD_RADIUS * tip) / HEAD;
        shaft.scale.set(SHAFT_RADIUS * size, length - tip, SHAFT_RADIUS * size);
        head.scale.set(Math.max(width, 1.5 * SHAFT_RADIUS * size), tip, Math.max(width, 1.5 * SHAFT_RADIUS * size));
        head.position.y = length - tip;
      }
    }
  }
}
