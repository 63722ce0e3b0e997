// A ring: the edge of a disc, through which one sees.

import { Group, Mesh, TorusGeometry, Vector3 } from "three";
import { ofCurve, surface } from "./material.js";

// The radius of the tube for a ring of radius 1; outside, the ring has its radius.
const TUBE = 0.03;
const RIM = new TorusGeometry(1 - TUBE, TUBE, 20, 96);
const AHEAD = new Vector3(0, 0, 1);
const LEAST = 1e-3;

export class Ring {
  constructor(shape, size) {
    this.group = new Group();
    this.group.add(new Mesh(RIM, surface(ofCurve(shape.hue))));
    this.least = LEAST * size;
    this.normal = new Vector3();
  }

  update(numbers, i) {
    this.group.position.fromArray(numbers, i);
    this.normal.fromArray(numbers, i + 3).normalize();
    this.group.quaternion.setFromUnitVectors(AHEAD, this.normal);
    this.group.scale.setScalar(Math.max(Math.abs(numbers[i + 6]), this.least));
  }
}
