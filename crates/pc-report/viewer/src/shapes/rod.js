// Rods with round ends, between points.

import { CylinderGeometry, Group, Mesh, SphereGeometry, Vector3 } from "three";

const CYLINDER = new CylinderGeometry(1, 1, 1, 20, 1, true);
const BALL = new SphereGeometry(1, 20, 14);
// Where rods meet, in units of their radius.
const JOINT = 1.5;
const UP = new Vector3(0, 1, 0);

export class Rods {
  constructor(corners, radius, material) {
    this.group = new Group();
    this.radius = radius;
    this.ends = Array.from({ length: corners }, () => new Mesh(BALL, material));
    this.rods = Array.from({ length: corners - 1 }, () => new Mesh(CYLINDER, material));
    this.group.add(...this.ends, ...this.rods);
    this.ends.forEach((end, n) => {
      const isJoint = n > 0 && n + 1 < corners;
      end.scale.setScalar(radius * (isJoint ? JOINT : 1));
    });
  }

  // Through the points from index `i` on.
  update(numbers, i) {
    this.ends.forEach((end, n) => end.position.fromArray(numbers, i + 3 * n));
    this.rods.forEach((rod, n) => {
      const from = this.ends[n].position;
      const way = this.ends[n + 1].position.clone().sub(from);
      const length = way.length();
      rod.position.copy(from).addScaledVector(way, 0.5);
      rod.scale.set(this.radius, length, this.radius);
      rod.visible = length > 0;
      if (rod.visible) {
        rod.quaternion.setFromUnitVectors(UP, way.divideScalar(length));
      }
    });
  }
}
