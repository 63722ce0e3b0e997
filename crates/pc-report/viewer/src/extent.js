// The size of the model, of its path, the plane of the motion if there is one, and the directions of the view.

import { positionsOf, reachOf } from "./data.js";

// The length, relative to the size of everything, that counts as zero.
const NOTHING = 1e-6;
// A path that is so many times longer than the model is not shown as a whole: the view follows.
const LONG = 4;
// What has no parts may be this much smaller than its path.
const LONG_FOR_A_BALL = 40;
// While a motion changes little by little, the view does so too: this much beyond the limits above.
const SLACK = 3;

class Bounds {
  low = [Infinity, Infinity, Infinity];
  high = [-Infinity, -Infinity, -Infinity];

  add(numbers, i, reach = [0, 0, 0]) {
    for (let k = 0; k < 3; k++) {
      const x = numbers[i + k];
      if (Number.isFinite(x)) {
        this.low[k] = Math.min(this.low[k], x - reach[k]);
        this.high[k] = Math.max(this.high[k], x + reach[k]);
      }
    }
  }

  extent() {
    return this.low.map((low, k) => Math.max(this.high[k] - low, 0) || 0);
  }

  middle() {
    return this.low.map((low, k) => (Number.isFinite(low) ? (low + this.high[k]) / 2 : 0));
  }

  size() {
    return Math.max(...this.extent());
  }
}

// `before`: whether the view followed the motion that this one takes the place of.
export function measured(data, before) {
  const { shapes, stills, width } = data;
  const count = data.times.length;
  const all = new Bounds();
  const places = new Bounds();
  const centres = new Float32Array(3 * count);
  let model = 0;
  for (let n = 0; n < count; n++) {
    const start = n * width;
    const still = new Bounds();
    const at = new Bounds();
    for (const shape of shapes) {
      const reach = reachOf(shape, stills, start);
      for (const i of positionsOf(shape)) {
        still.add(stills, start + i, reach);
        at.add(stills, start + i);
        all.add(stills, start + i, reach);
        places.add(stills, start + i);
      }
    }
    model = Math.max(model, still.size());
    centres.set(at.middle(), 3 * n);
  }
  const path = all.size();
  const flat = flatAxis(data, places.extent(), path);
  const long = isSimple(data) ? LONG_FOR_A_BALL : LONG;
  const slack = before === undefined ? 1 : before ? 1 / SLACK : SLACK;
  const follows = model > NOTHING * path && path > slack * long * model;
  const size = (follows ? model : path) || 1;
  const { right, up, isTop } = directions(data.down, flat);
  const isUpright = flat !== undefined && !isTop;
  return { size, follows, flat, right, up, isTop, isUpright, middle: all.middle(), low: all.low, high: all.high, centres };
}

// Whether the model is a ball or a point, which does not show its motion relative to itself.
export function isSimple({ shapes }) {
  const solid = shapes.filter((shape) => shape.kind !== "trace" && shape.kind !== "text");
  return solid.length === 1 && (solid[0].kind === "sphere" || solid[0].kind === "point");
}

// The axis to which all motion is perpendicular, the last if there are more; undefined for a motion in space.
function flatAxis(data, extent, path) {
  const isFlat = (k) => path > 0 && extent[k] <= NOTHING * path && staysIn(data, k);
  return [2, 1, 0].find(isFlat);
}

// Whether discs stay in the plane perpendicular to an axis, and what turns does so about the axis.
function staysIn({ shapes, stills, width }, flat) {
  for (const shape of shapes) {
    for (let i = shape.at; i < stills.length; i += width) {
      const isTilted = (x, k) => k !== flat && Math.abs(x) > NOTHING;
      if ((shape.kind === "disc" || shape.kind === "ring") && stills.subarray(i + 3, i + 6).some(isTilted)) {
        return false;
      }
      const rotation = { box: 6, axes: 3 }[shape.kind];
      if (rotation !== undefined) {
        // One of the own axes stays perpendicular to the plane.
        const row = stills.subarray(i + rotation + 3 * flat, i + rotation + 3 * flat + 3);
        if (Math.max(...row.map(Math.abs)) < 1 - NOTHING) {
          return false;
        }
      }
    }
  }
  return true;
}

// The directions right and up of the front view. Where nothing says which way is down, up is the third axis, or the second
// for a motion in a plane perpendicular to the third.
function directions(down, flat) {
  const steepest = Math.max(...down.map(Math.abs));
  let axis = flat === 2 ? 1 : 2;
  let sign = 1;
  if (steepest > 0) {
    axis = down.findIndex((g) => Math.abs(g) === steepest);
    sign = down[axis] > 0 ? -1 : 1;
  }
  const isTop = flat === axis;
  let right = axis === 0 ? 1 : 0;
  if (flat !== undefined && !isTop) {
    right = 3 - axis - flat;
  }
  const unit = (k, x) => [0, 1, 2].map((i) => (i === k ? x : 0));
  return { right: unit(right, 1), up: unit(axis, sign), isTop };
}
