// A bar of a round length, in the units of the model, at the distance of what is looked at.

import { roundBelow, written } from "./numbers.js";

const WIDEST = 140;

export class ScaleBar {
  constructor(size, parent) {
    this.size = size;
    this.element = document.createElement("div");
    this.element.className = "scale-bar";
    this.element.setAttribute("aria-hidden", "true");
    parent.append(this.element);
  }

  // `perUnit` pixels show the size of the model.
  update(perUnit, width) {
    const pixels = perUnit / this.size;
    const length = roundBelow(Math.min(WIDEST, width / 3) / pixels);
    const text = written(length);
    const wide = `${(length * pixels).toFixed(1)}px`;
    if (this.element.textContent !== text) {
      this.element.textContent = text;
    }
    this.element.style.width = wide;
  }
}
