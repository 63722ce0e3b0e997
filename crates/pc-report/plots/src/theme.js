// The colours of the page, which a canvas cannot take from the style sheet by itself.

const known = new Map();

export function colour(name) {
  if (!known.has(name)) {
    known.set(name, getComputedStyle(document.documentElement).getPropertyValue(name).trim() || "#888");
  }
  return known.get(name);
}

// Calls back when the reader turns from light to dark or back.
export function onChange(redraw) {
  window.matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => {
    known.clear();
    redraw();
  });
}
