// A surface of triangles, with flat faces.

import { BufferAttribute, BufferGeometry, DoubleSide, Group, Mesh } from "three";
import { rotation } from "../pose.js";
import { ofCurve, surface } from "./material.js";

export class Surface {
  constructor(shape) {
    const geometry = new BufferGeometry();
    geometry.setAttribute("position", new BufferAttribute(shape.mesh.corners, 3));
    geometry.setIndex(new BufferAttribute(shape.mesh.faces, 1));
    // Files do not always say which side is outside.
    const material = surface(ofCurve(shape.hue), { flatShading: true, side: DoubleSide });
    this.group = new Group();
    this.group.matrixAutoUpdate = false;
    this.group.add(new Mesh(geometry, material));
  }

  update(numbers, i) {
    rotation(this.group.matrix, numbers, i + 3).setPosition(numbers[i], numbers[i + 1], numbers[i + 2]);
  }
}
