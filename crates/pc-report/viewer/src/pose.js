// The numbers of all shapes between two stills: positions along straight lines, rotations at a constant rate.

import { Matrix4, Quaternion } from "three";

// Where the rotation matrix begins among the numbers of a shape.
const ROTATIONS = { box: 6, axes: 3, mesh: 3 };
// How far the determinant of a rotation may be from 1.
const SLACK = 1e-3;

const [before, after] = [new Matrix4(), new Matrix4()];
const [from, to] = [new Quaternion(), new Quaternion()];

// A matrix from its rows.
export function rotation(matrix, numbers, i) {
  const r = numbers;
  return matrix.set(
    r[i], r[i + 1], r[i + 2], 0,
    r[i + 3], r[i + 4], r[i + 5], 0,
    r[i + 6], r[i + 7], r[i + 8], 0,
    0, 0, 0, 1,
  );
}

export class Pose {
  constructor(data) {
    this.data = data;
    this.numbers = new Float32Array(data.width);
    this.rotations = data.shapes
      .filter((shape) => shape.kind in ROTATIONS)
      .map((shape) => shape.at + ROTATIONS[shape.kind]);
    this.set(0);
  }

  // `position` counts stills: 2.5 is half way from the third to the fourth.
  set(position) {
    const { stills, width } = this.data;
    const n = Math.floor(position);
    const part = position - n;
    const start = n * width;
    this.position = position;
    this.numbers.set(stills.subarray(start, start + width));
    if (part === 0) {
      return;
    }
    for (let i = 0; i < width; i++) {
      this.numbers[i] += part * (stills[start + width + i] - stills[start + i]);
    }
    for (const i of this.rotations) {
      this.turn(i, start, part);
    }
  }

  turn(i, start, part) {
    const { stills, width } = this.data;
    rotation(before, stills, start + i);
    rotation(after, stills, start + width + i);
    if (Math.abs(before.determinant() - 1) > SLACK || Math.abs(after.determinant() - 1) > SLACK) {
      return;
    }
    from.setFromRotationMatrix(before);
    to.setFromRotationMatrix(after);
    const e = before.makeRotationFromQuaternion(from.slerp(to, part)).elements;
    for (let row = 0; row < 3; row++) {
      for (let column = 0; column < 3; column++) {
        this.numbers[i + 3 * row + column] = e[row + 4 * column];
      }
    }
  }
}
