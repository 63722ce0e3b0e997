// What the view follows: nothing, the middle of the model, or a point of it.

import { Vector3 } from "three";
import { positionsOf, reachOf } from "./data.js";
import { radiusOf } from "./shapes/point.js";

export const [NOTHING, MODEL] = ["nothing", "model"];

// What may be followed, as pairs of a value and words.
export function anchorsOf(data) {
  const named = data.shapes.filter((shape) => shape.kind === "point" && shape.text);
  const places = named.map((shape) => [String(shape.at), shape.text]);
  return [[NOTHING, "nothing"], [MODEL, "the model"], ...places];
}

// Balls [x, y, z, radius] that span a shape: places relative to its position, radii in units of the size of the model.
function spanning(shape, numbers, start, size) {
  if (shape.kind === "point" || shape.kind === "sphere") {
    return [[0, 0, 0, shape.kind === "point" ? radiusOf(shape) : reachOf(shape, numbers, start)[0] / size]];
  }
  const reach = reachOf(shape, numbers, start);
  if (reach.every((x) => x === 0)) {
    return [[0, 0, 0, 0]];
  }
  return [0, 1, 2, 3, 4, 5, 6, 7].map((bits) => [...reach.map((x, k) => (bits & (1 << k) ? x : -x)), 0]);
}

export class Anchor {
  constructor(data, extent, world, chosen) {
    Object.assign(this, { data, extent, world, chosen });
  }

  // The place in the view of what is followed, `position` stills after the start. What is not known stays in the
  // middle.
  at(position, place = new Vector3()) {
    const { data, extent, chosen } = this;
    if (chosen === NOTHING) {
      return place.set(0, 0, 0);
    }
    const [numbers, width, i] = chosen === MODEL ? [extent.centres, 3, 0] : [data.stills, data.width, Number(chosen)];
    const n = Math.floor(position);
    const after = new Vector3().fromArray(numbers, Math.min(n + 1, data.times.length - 1) * width + i);
    place.fromArray(numbers, n * width + i).lerp(after, position - n).applyMatrix4(this.world.matrix);
    return Number.isFinite(place.lengthSq()) ? place : place.set(0, 0, 0);
  }

  // All positions of all shapes relative to what is followed, as [x, y, z, radius] one after the other.
  balls() {
    const { data, extent } = this;
    const [balls, anchor, place, corner] = [[], new Vector3(), new Vector3(), new Vector3()];
    for (let n = 0; n < data.times.length; n++) {
      this.at(n, anchor);
      for (const shape of data.shapes) {
        const start = n * data.width;
        for (const i of positionsOf(shape)) {
          for (const [x, y, z, radius] of spanning(shape, data.stills, start, extent.size)) {
            place.fromArray(data.stills, start + i).add(corner.set(x, y, z));
            place.applyMatrix4(this.world.matrix).sub(anchor);
            balls.push(place.x, place.y, place.z, radius);
          }
        }
      }
    }
    return balls;
  }
}
