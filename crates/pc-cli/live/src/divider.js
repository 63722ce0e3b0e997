// A line between two parts of the page that can be moved, by a pointer or by arrow keys.

const STEP = 0.02;

export class Divider {
  // Keeps the part before the line as a custom property of the box, from 0 to 1.
  constructor(line, box, property, isUpright, start) {
    Object.assign(this, { line, box, property, isUpright });
    this.first = start;
    this.set(remembered(property) ?? start);
    line.addEventListener("pointerdown", (event) => {
      line.setPointerCapture(event.pointerId);
      event.preventDefault();
    });
    line.addEventListener("pointermove", (event) => {
      if (line.hasPointerCapture(event.pointerId)) {
        const { left, top, width, height } = box.getBoundingClientRect();
        this.set(isUpright ? (event.clientX - left) / width : (event.clientY - top) / height);
      }
    });
    line.addEventListener("dblclick", () => this.set(start));
    line.addEventListener("keydown", (event) => {
      const keys = isUpright ? ["ArrowLeft", "ArrowRight"] : ["ArrowUp", "ArrowDown"];
      const way = keys.indexOf(event.key);
      if (way >= 0) {
        event.preventDefault();
        this.set(this.part + (way === 0 ? -STEP : STEP));
      }
    });
  }

  set(part) {
    this.part = Math.min(0.85, Math.max(0.15, part));
    this.box.style.setProperty(this.property, this.part.toFixed(4));
    this.line.setAttribute("aria-valuenow", String(Math.round(100 * this.part)));
    remember(this.property, this.part);
  }
}

// A browser may keep nothing for a page.
function remembered(key) {
  try {
    const part = Number(sessionStorage.getItem(`pc${key}`));
    return part > 0 ? part : undefined;
  } catch {
    return undefined;
  }
}

function remember(key, part) {
  try {
    sessionStorage.setItem(`pc${key}`, String(part));
  } catch {
    // Then the line is in its first place next time.
  }
}
