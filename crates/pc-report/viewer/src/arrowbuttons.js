// Buttons that show and hide arrows, one for each quantity that the motion has.

import { name } from "./icons.js";
import { QUANTITIES } from "./quantities.js";

export class ArrowButtons {
  // `shown` is the set of quantities; `changed` is called when it changes.
  constructor(root, shown, changed) {
    this.shown = shown;
    this.element = document.createElement("div");
    this.element.className = "arrows";
    this.element.setAttribute("role", "group");
    this.element.setAttribute("aria-label", "Arrows");
    const words = document.createElement("span");
    words.textContent = "Arrows";
    this.buttons = Object.entries(QUANTITIES).map(([quantity, { sign, hint }]) => {
      const button = document.createElement("button");
      Object.assign(button, { type: "button", textContent: sign });
      button.dataset.arrows = quantity;
      name(button, hint);
      button.addEventListener("click", () => {
        if (!shown.delete(quantity)) {
          shown.add(quantity);
        }
        changed();
      });
      return { quantity, button };
    });
    this.element.append(words, ...this.buttons.map(({ button }) => button));
    root.querySelector(".views").before(this.element);
  }

  // Offers the quantities that a motion has; the others are not shown.
  offer(known) {
    this.element.hidden = known.size === 0;
    for (const { quantity, button } of this.buttons) {
      button.hidden = !known.has(quantity);
      if (button.hidden) {
        this.shown.delete(quantity);
      }
    }
  }

  update() {
    for (const { quantity, button } of this.buttons) {
      button.setAttribute("aria-pressed", String(this.shown.has(quantity)));
    }
  }
}
