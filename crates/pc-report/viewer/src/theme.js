// The colours of the page, from its custom properties.

import { Color } from "three";

const CURVES = 8;

export class Theme {
  constructor(element) {
    this.element = element;
    this.read();
  }

  read() {
    const style = getComputedStyle(this.element);
    const colour = (name) => new Color(style.getPropertyValue(name).trim() || "#888");
    this.ink = colour("--ink");
    this.soft = colour("--soft");
    this.paper = colour("--paper");
    this.panel = colour("--panel");
    this.line = colour("--line");
    this.curves = Array.from({ length: CURVES }, (_, i) => colour(`--c${i}`));
    const brightness = ({ r, g, b }) => r + g + b;
    this.isDark = brightness(this.paper) < brightness(this.ink);
    this.rod = this.soft.clone().lerp(this.paper, this.isDark ? 0 : 0.25);
  }

  // Calls `changed` when the reader, or the system, changes between light and dark.
  watch(changed) {
    window.matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => {
      this.read();
      changed();
    });
  }
}
