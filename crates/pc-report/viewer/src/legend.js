// What lengths of arrows mean: for each quantity that is shown, a bar and the round number that it stands for.

import { roundBelow, written } from "./numbers.js";
import { QUANTITIES } from "./quantities.js";

const WIDEST = 90;

export class Legend {
  constructor(parent) {
    this.element = document.createElement("div");
    this.element.className = "legend";
    parent.append(this.element);
    this.rows = new Map();
  }

  // `pixels` are those of a vector of length 1, by quantity; the picture is `width` wide.
  update(shown, pixels, width) {
    for (const [quantity, { element }] of this.rows) {
      element.hidden = !shown.has(quantity);
    }
    for (const quantity of shown) {
      const { bar, text } = this.row(quantity);
      const most = pixels(quantity);
      const round = roundBelow(Math.min(WIDEST, width / 6) / most);
      bar.style.width = `${(round * most).toFixed(1)}px`;
      const words = `${QUANTITIES[quantity].words} ${written(round)}`;
      if (text.textContent !== words) {
        text.textContent = words;
      }
    }
  }

  row(quantity) {
    if (!this.rows.has(quantity)) {
      const [element, bar, text] = ["div", "i", "span"].map((name) => document.createElement(name));
      bar.style.color = `var(--c${QUANTITIES[quantity].hue})`;
      element.append(bar, text);
      this.element.append(element);
      this.rows.set(quantity, { element, bar, text });
    }
    return this.rows.get(quantity);
  }
}
