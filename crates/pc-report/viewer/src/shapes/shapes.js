// All solid shapes of a scene.

import { Group } from "three";
import { Axes } from "./axes.js";
import { Box } from "./box.js";
import { Disc } from "./disc.js";
import { Line } from "./line.js";
import { colour } from "./material.js";
import { Surface } from "./mesh.js";
import { Point } from "./point.js";
import { Ring } from "./ring.js";
import { Sphere } from "./sphere.js";
import { Spring } from "./spring.js";

const BUILDERS = {
  axes: Axes, box: Box, disc: Disc, line: Line, mesh: Surface, point: Point, ring: Ring, sphere: Sphere, spring: Spring,
};

export class Shapes {
  constructor(data, size) {
    this.group = new Group();
    this.list = data.shapes
      .filter((shape) => shape.kind in BUILDERS)
      .map((shape) => ({ shape, solid: new BUILDERS[shape.kind](shape, size) }));
    this.list.forEach(({ solid }) => this.group.add(solid.group));
    this.group.traverse((object) => {
      object.castShadow = Boolean(object.isMesh);
      object.receiveShadow = Boolean(object.isMesh && !object.material.transparent);
    });
  }

  colour(theme) {
    colour(this.group, theme);
  }

  // A shape is hidden as long as one of its numbers is not known.
  update(numbers) {
    for (const { shape, solid } of this.list) {
      const own = numbers.subarray(shape.at, shape.at + shape.count);
      solid.group.visible = own.every(Number.isFinite);
      if (solid.group.visible) {
        solid.update(numbers, shape.at);
      }
    }
  }
}
