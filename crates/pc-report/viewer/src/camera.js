// The viewpoint: a direction towards a target, in perspective or not.

import { MathUtils, OrthographicCamera, PerspectiveCamera, Vector3 } from "three";
import { clamp, smoothStep } from "./numbers.js";

const FIELD = 24;
const HALF = Math.tan(MathUtils.degToRad(FIELD / 2));
// The part of the picture that a fitted motion fills.
const FILLED = 0.84;
const STEEPEST = Math.PI / 2;
const [NEAREST, FARTHEST] = [0.02, 400];
// A fitted view is not closer, where there is only a point that does not move.
const CLOSEST = 1.5;
// How far behind the target there is something to see, in units of the distance, and of the model at least.
const [DEPTH, LEAST_DEPTH] = [25, 60];
const SECONDS = 0.45;

// Angles of the views along the axes.
export const VIEWS = {
  front: { yaw: 0, pitch: 0 },
  side: { yaw: Math.PI / 2, pitch: 0 },
  top: { yaw: 0, pitch: STEEPEST },
  space: { yaw: -0.55, pitch: 0.3 },
};

export class Viewpoint {
  constructor(isStill) {
    this.isStill = isStill;
    this.perspective = new PerspectiveCamera(FIELD, 1, 0.01, 100);
    this.flat = new OrthographicCamera();
    this.isFlat = false;
    this.aspect = 1;
    // What the view follows, and the target relative to it.
    this.anchor = new Vector3();
    this.offset = new Vector3();
    this.yaw = 0;
    this.pitch = 0;
    this.distance = 4;
    this.change = null;
  }

  get camera() {
    return this.isFlat ? this.flat : this.perspective;
  }

  get target() {
    return this.anchor.clone().add(this.offset);
  }

  // The directions right, up and towards the eye.
  directions(yaw = this.yaw, pitch = this.pitch) {
    const back = new Vector3(Math.sin(yaw) * Math.cos(pitch), Math.sin(pitch), Math.cos(yaw) * Math.cos(pitch));
    const right = new Vector3(Math.cos(yaw), 0, -Math.sin(yaw));
    return { right, up: back.clone().cross(right), back };
  }

  // Places both cameras.
  update() {
    const { right, up, back } = this.directions();
    const target = this.target;
    const depth = Math.max(DEPTH * this.distance, LEAST_DEPTH);
    for (const camera of [this.perspective, this.flat]) {
      camera.position.copy(back).multiplyScalar(this.distance).add(target);
      camera.matrixAutoUpdate = false;
      camera.matrix.makeBasis(right, up, back).setPosition(camera.position);
      camera.matrix.decompose(camera.position, camera.quaternion, camera.scale);
      camera.far = this.distance + depth;
    }
    this.perspective.near = this.distance / 40;
    this.perspective.aspect = this.aspect;
    const half = this.halfHeight();
    const width = half * this.aspect;
    Object.assign(this.flat, { left: -width, right: width, top: half, bottom: -half, near: this.distance - depth });
    this.perspective.updateProjectionMatrix();
    this.flat.updateProjectionMatrix();
    this.camera.updateMatrixWorld(true);
  }

  // Half the height of what is seen at the target.
  halfHeight() {
    return this.distance * HALF;
  }

  // Where a point is on a picture of a width and a height, in pixels, and the pixels of a unit there. Changes the point.
  seen(point, { width, height }) {
    const { camera } = this;
    const depth = -point.applyMatrix4(camera.matrixWorldInverse).z;
    const scale = height / (2 * HALF * (this.isFlat ? this.distance : depth));
    point.applyMatrix4(camera.projectionMatrix);
    const isSeen = Number.isFinite(point.x) && Math.abs(point.z) <= 1;
    return { x: ((point.x + 1) / 2) * width, y: ((1 - point.y) / 2) * height, scale, isSeen };
  }

  turn(yaw, pitch) {
    this.change = null;
    this.yaw += yaw;
    this.pitch = clamp(this.pitch + pitch, -STEEPEST, STEEPEST);
  }

  // Moves the target by parts of the height of the picture.
  pan(x, y) {
    this.change = null;
    const { right, up } = this.directions();
    const scale = 2 * this.halfHeight();
    this.offset.addScaledVector(right, -x * scale).addScaledVector(up, -y * scale);
  }

  // Makes things larger; what is under (x, y), in units of half the height from the middle, stays there.
  zoom(factor, x = 0, y = 0) {
    this.change = null;
    const distance = clamp(this.distance / factor, NEAREST, FARTHEST);
    const { right, up } = this.directions();
    const shift = (this.distance - distance) * HALF;
    this.offset.addScaledVector(right, x * shift).addScaledVector(up, y * shift);
    this.distance = distance;
  }

  // The offset and the distance from which all balls [x, y, z, radius], relative to the anchor, are seen.
  fitted(balls, { yaw, pitch }) {
    const { right, up, back } = this.directions(yaw, pitch);
    const axes = [right, up, back];
    const along = (axis, i) => axis.x * balls[i] + axis.y * balls[i + 1] + axis.z * balls[i + 2];
    const low = [Infinity, Infinity, Infinity];
    const high = [-Infinity, -Infinity, -Infinity];
    const places = [];
    for (let i = 0; i < balls.length; i += 4) {
      const place = axes.map((axis) => along(axis, i));
      if (place.every(Number.isFinite)) {
        place.push(balls[i + 3]);
        places.push(place);
        place.slice(0, 3).forEach((x, k) => {
          low[k] = Math.min(low[k], x - place[3]);
          high[k] = Math.max(high[k], x + place[3]);
        });
      }
    }
    if (places.length === 0) {
      return { offset: new Vector3(), distance: CLOSEST };
    }
    const middle = low.map((x, k) => (x + high[k]) / 2);
    const room = [FILLED * HALF * this.aspect, FILLED * HALF];
    let distance = CLOSEST;
    for (const [x, y, z, radius] of places) {
      // Of what is nearer to the eye, less fits into the picture.
      const nearer = this.isFlat ? 0 : z - middle[2] + radius;
      const across = [Math.abs(x - middle[0]) + radius, Math.abs(y - middle[1]) + radius];
      distance = Math.max(distance, nearer + across[0] / room[0], nearer + across[1] / room[1]);
    }
    distance = Math.min(distance, FARTHEST);
    const offset = new Vector3();
    axes.forEach((axis, k) => offset.addScaledVector(axis, middle[k]));
    return { offset, distance };
  }

  // Goes to a view, which gives the angles, the offset and the distance, or some of these.
  go(view, isSudden = false) {
    const goal = { yaw: this.yaw, pitch: this.pitch, offset: this.offset.clone(), distance: this.distance, ...view };
    // The shorter way round.
    goal.yaw = this.yaw + MathUtils.euclideanModulo(goal.yaw - this.yaw + Math.PI, 2 * Math.PI) - Math.PI;
    const start = { yaw: this.yaw, pitch: this.pitch, offset: this.offset.clone(), distance: this.distance };
    this.change = { start, goal, seconds: 0 };
    if (isSudden || this.isStill) {
      this.advance(SECONDS);
    }
  }

  // Stays where it is in the space of the model, when the unit and the origin of the view change: a point p is at
  // p scale + shift from then on. What is followed moves by itself.
  keep(scale, shift) {
    for (const view of this.change ? [this, this.change.start, this.change.goal] : [this]) {
      view.offset.multiplyScalar(scale).add(shift);
      view.distance = clamp(view.distance * scale, NEAREST, FARTHEST);
    }
  }

  // Where the view goes to, or is.
  goal() {
    return this.change ? this.change.goal : this;
  }

  // Goes on with a change of view; tells whether there is one.
  advance(seconds) {
    if (!this.change) {
      return false;
    }
    const { start, goal } = this.change;
    this.change.seconds += seconds;
    const part = smoothStep(0, SECONDS, this.change.seconds);
    this.yaw = MathUtils.lerp(start.yaw, goal.yaw, part);
    this.pitch = MathUtils.lerp(start.pitch, goal.pitch, part);
    this.distance = start.distance * (goal.distance / start.distance) ** part;
    this.offset.lerpVectors(start.offset, goal.offset, part);
    if (part === 1) {
      this.change = null;
    }
    return true;
  }
}
