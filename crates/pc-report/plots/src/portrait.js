// A picture of one column against another, from the curves, where the page has none.

import { beside } from "./words.js";

const [WIDE, HIGH] = [360, 260];
// Room for numbers beside the axes and for their names.
const [LEFT, RIGHT, TOP, BOTTOM] = [58, 12, 20, 40];
const TICKS = 4;

// The namespace of drawings, whose name is an address, which no script of a page may contain.
const NAMESPACE = (() => {
  const template = document.createElement("template");
  template.innerHTML = "<svg></svg>";
  return template.content.firstChild.namespaceURI;
})();

function drawn(name, attributes, text = "") {
  const element = document.createElementNS(NAMESPACE, name);
  Object.entries(attributes).forEach(([key, value]) => element.setAttribute(key, value));
  element.textContent = text;
  return element;
}

// The ends of the values with some room.
function ends(values) {
  let [low, high] = [Infinity, -Infinity];
  for (const value of values) {
    if (value !== null) {
      low = Math.min(low, value);
      high = Math.max(high, value);
    }
  }
  if (!(low <= high)) {
    return [-1, 1];
  }
  const half = high > low ? 0.05 * (high - low) : Math.abs(high) / 10 || 1;
  return [low - half, high + half];
}

// Round numbers between two ends, and the step between them.
function ticks(low, high) {
  const rough = (high - low) / TICKS;
  const power = 10 ** Math.floor(Math.log10(rough));
  const step = [1, 2, 5, 10].map((k) => k * power).find((size) => size >= rough * 0.999);
  const numbers = [];
  for (let k = Math.ceil(low / step); k * step <= high; k++) {
    numbers.push(k * step);
  }
  return { numbers, words: beside(numbers, step) };
}

// The picture, and the path with the ends of the axes on it.
export function portrait(path, curves) {
  const [x, y] = [curves.get(path.x), curves.get(path.y)];
  const picture = drawn("svg", { viewBox: `0 0 ${WIDE} ${HIGH}`, role: "img", "aria-label": `${path.y} over ${path.x}` });
  const across = [...ends(x?.values ?? []), LEFT, WIDE - RIGHT];
  const up = [...ends(y?.values ?? []), HIGH - BOTTOM, TOP];
  const at = ([low, high, from, to], value) => from + ((value - low) / (high - low)) * (to - from);
  const columns = ticks(across[0], across[1]);
  columns.numbers.forEach((number, i) => {
    const place = at(across, number);
    picture.append(drawn("path", { class: "grid", d: `M${place} ${TOP}V${HIGH - BOTTOM}` }));
    picture.append(drawn("text", { x: place, y: HIGH - BOTTOM + 16, "text-anchor": "middle" }, columns.words[i]));
  });
  const rows = ticks(up[0], up[1]);
  rows.numbers.forEach((number, i) => {
    const place = at(up, number);
    picture.append(drawn("path", { class: "grid", d: `M${LEFT} ${place}H${WIDE - RIGHT}` }));
    picture.append(drawn("text", { x: LEFT - 6, y: place + 4, "text-anchor": "end" }, rows.words[i]));
  });
  picture.append(drawn("text", { x: WIDE - RIGHT, y: HIGH - 6, "text-anchor": "end" }, path.x));
  picture.append(drawn("text", { x: LEFT, y: TOP - 7, "text-anchor": "middle" }, path.y));
  if (x && y) {
    let way = "";
    let isOn = false;
    x.values.forEach((value, i) => {
      const other = y.values[i];
      const isKnown = value !== null && other !== null && other !== undefined;
      way += isKnown ? `${isOn ? "L" : "M"}${at(across, value).toFixed(1)} ${at(up, other).toFixed(1)}` : "";
      isOn = isKnown;
    });
    picture.append(drawn("path", { class: "curve s0", d: way }));
  }
  return { picture, path: { ...path, across, up } };
}
