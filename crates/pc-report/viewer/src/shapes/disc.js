// A disc: a rim, and faces through which other shapes are seen. Nothing is known of how it turns about its
// normal, so it has no spokes.

import { CircleGeometry, DoubleSide, Group, Mesh, TorusGeometry, Vector3 } from "three";
import { ofCurve, surface } from "./material.js";

// The radius of the rim's tube for a disc of radius 1; outside, the rim has the radius of the disc.
const TUBE = 0.035;
const RIM = new TorusGeometry(1 - TUBE, TUBE, 20, 96);
const FACE = new CircleGeometry(1 - TUBE, 96);
const AHEAD = new Vector3(0, 0, 1);
const LEAST = 1e-3;

export class Disc {
  constructor(shape, size) {
    const rim = new Mesh(RIM, surface(ofCurve(shape.hue)));
    const face = new Mesh(
      FACE,
      surface(ofCurve(shape.hue), { transparent: true, opacity: 0.32, side: DoubleSide, depthWrite: false }),
    );
    this.group = new Group();
    this.group.add(rim, face);
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
