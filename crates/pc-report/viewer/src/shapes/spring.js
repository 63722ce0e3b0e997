// A spring: a wire wound around the line between two ends.

import { BufferAttribute, BufferGeometry, Mesh, Vector3 } from "three";
import { smoothStep } from "../numbers.js";
import { ofRods, surface } from "./material.js";

const WINDINGS = 8;
const STEPS = 18;
const SIDES = 8;
const [WIRE, COIL] = [0.006, 0.032];
// The straight parts at both ends, relative to the length.
const STRAIGHT = 0.1;
// The part of the coil over which it comes to its width.
const RISE = 0.6 / WINDINGS;
const RINGS = WINDINGS * STEPS + 5;

// The place of the middle of the wire along the spring, its distance from the line between the ends in units of the
// coil, and the angle about that line.
function middle(ring) {
  const last = RINGS - 1;
  if (ring < 2 || ring > last - 2) {
    return [{ 0: 0, 1: STRAIGHT, [last - 1]: 1 - STRAIGHT, [last]: 1 }[ring], 0, 0];
  }
  const part = (ring - 2) / (last - 4);
  const out = smoothStep(0, RISE, Math.min(part, 1 - part));
  return [STRAIGHT + part * (1 - 2 * STRAIGHT), out, 2 * Math.PI * WINDINGS * part];
}

function faces() {
  const index = [];
  for (let ring = 0; ring + 1 < RINGS; ring++) {
    for (let side = 0; side < SIDES; side++) {
      const [a, b] = [ring * SIDES + side, ring * SIDES + ((side + 1) % SIDES)];
      index.push(a, b, a + SIDES, b, b + SIDES, a + SIDES);
    }
  }
  return index;
}

export class Spring {
  constructor(_, size) {
    this.geometry = new BufferGeometry();
    this.places = new Float32Array(3 * RINGS * SIDES);
    this.normals = new Float32Array(3 * RINGS * SIDES);
    this.geometry.setAttribute("position", new BufferAttribute(this.places, 3));
    this.geometry.setAttribute("normal", new BufferAttribute(this.normals, 3));
    this.geometry.setIndex(faces());
    this.group = new Mesh(this.geometry, surface(ofRods));
    this.group.frustumCulled = false;
    this.size = size;
  }

  update(numbers, i) {
    const from = new Vector3().fromArray(numbers, i);
    const way = new Vector3().fromArray(numbers, i + 3).sub(from);
    const length = way.length();
    const ahead = length > 0 ? way.clone().divideScalar(length) : new Vector3(0, 0, 1);
    const side = new Vector3(Math.abs(ahead.x) > 0.8 ? 0 : 1, Math.abs(ahead.x) > 0.8 ? 1 : 0, 0);
    side.addScaledVector(ahead, -side.dot(ahead)).normalize();
    const other = ahead.clone().cross(side);
    const [wire, coil] = [WIRE * this.size, Math.min(COIL * this.size, length / 4)];
    const centres = Array.from({ length: RINGS }, (_, ring) => {
      const [part, out, angle] = middle(ring);
      return from.clone().addScaledVector(way, part)
        .addScaledVector(side, out * coil * Math.cos(angle))
        .addScaledVector(other, out * coil * Math.sin(angle));
    });
    const normal = new Vector3();
    centres.forEach((centre, ring) => {
      const along = centres[Math.min(ring + 1, RINGS - 1)].clone().sub(centres[Math.max(ring - 1, 0)]).normalize();
      const a = ahead.clone().addScaledVector(along, -ahead.dot(along));
      if (a.lengthSq() < 1e-6) {
        a.copy(side);
      }
      a.normalize();
      const b = along.cross(a);
      for (let n = 0; n < SIDES; n++) {
        const angle = (2 * Math.PI * n) / SIDES;
        const k = 3 * (ring * SIDES + n);
        normal.copy(a).multiplyScalar(Math.cos(angle)).addScaledVector(b, Math.sin(angle)).toArray(this.normals, k);
        normal.multiplyScalar(wire).add(centre).toArray(this.places, k);
      }
    });
    this.geometry.attributes.position.needsUpdate = true;
    this.geometry.attributes.normal.needsUpdate = true;
  }
}
