// The directions of the fixed axes, in a corner of the picture.

import { Vector3 } from "three";
import { AXES } from "./axes.js";
import { drawn } from "./svg.js";

const SIZE = 84;
const LENGTH = 26;
const NAME = 35;

export class Compass {
  constructor(world, parent) {
    this.svg = drawn("svg", { class: "compass", viewBox: `${-SIZE / 2} ${-SIZE / 2} ${SIZE} ${SIZE}`, "aria-hidden": "true" });
    // Without the scale of the model's space.
    this.axes = AXES.map(({ name, hue }, k) => {
      const direction = new Vector3().setFromMatrixColumn(world.matrix, k).normalize();
      const group = drawn("g", { style: `color: var(--c${hue})` });
      const line = drawn("line", {});
      const text = drawn("text", {});
      text.textContent = name;
      group.append(line, text);
      return { direction, group, line, text };
    });
    parent.append(this.svg);
  }

  update({ right, up, back }) {
    const seen = this.axes.map((axis) => {
      const [x, y, z] = [right, up, back].map((along) => along.dot(axis.direction));
      return { ...axis, x, y: -y, z };
    });
    seen.sort((a, b) => a.z - b.z);
    for (const { group, line, text, x, y, z } of seen) {
      line.setAttribute("x2", (LENGTH * x).toFixed(2));
      line.setAttribute("y2", (LENGTH * y).toFixed(2));
      text.setAttribute("x", (NAME * x).toFixed(2));
      text.setAttribute("y", (NAME * y).toFixed(2));
      // An axis that points to the eye has no place for its name.
      group.style.opacity = Math.hypot(x, y) < 0.2 ? "0" : String(0.75 + 0.25 * z);
      this.svg.append(group);
    }
  }
}
