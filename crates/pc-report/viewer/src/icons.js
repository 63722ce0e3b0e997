// The pictures on buttons, which take the place of their words; the words remain as names and hints.

import { drawn } from "./svg.js";

// Strokes and areas on a square of 24.
const ICONS = {
  play: { areas: "M7 4.5v15l13-7.5z" },
  pause: { areas: "M6 4.5h4.2v15H6zM13.8 4.5H18v15h-4.2z" },
  back: { areas: "M17 5v14L8 12z", strokes: "M6 5v14" },
  ahead: { areas: "M7 5v14l9-7z", strokes: "M18 5v14" },
  loop: { strokes: "M4 12a6 6 0 0 1 6-6h9M16 3l3 3-3 3M20 12a6 6 0 0 1-6 6H5M8 15l-3 3 3 3" },
  trails: { strokes: "M3 18c4 0 4-11 9-11 4 0 4 6 6.5 6", areas: "M18.5 10.5a2.5 2.5 0 1 0 0 5 2.5 2.5 0 1 0 0-5z" },
  fit: { strokes: "M4 9V4h5M15 4h5v5M20 15v5h-5M9 20H4v-5", areas: "M9 9h6v6H9z" },
  flat: { strokes: "M4 8.5h11.5V20H4zM4 8.5 8.5 4H20v11.5L15.5 20M15.5 8.5 20 4" },
  full: { strokes: "M14 4h6v6M20 4l-7 7M10 20H4v-6M4 20l7-7" },
};

function icon(name) {
  const svg = drawn("svg", { class: "icon", viewBox: "0 0 24 24", "aria-hidden": "true" });
  const { strokes, areas } = ICONS[name];
  if (strokes) {
    svg.append(drawn("path", { class: "stroke", d: strokes }));
  }
  if (areas) {
    svg.append(drawn("path", { class: "area", d: areas }));
  }
  return svg;
}

// Gives a button a picture instead of its words.
export function picture(button, name) {
  if (button.dataset.icon !== name) {
    button.dataset.icon = name;
    button.replaceChildren(icon(name));
  }
}

// Gives a button a name, which is shown as a hint with the key that does the same.
export function name(button, words, key) {
  button.setAttribute("aria-label", words);
  button.title = key ? `${words} (${key})` : words;
}
