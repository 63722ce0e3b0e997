// A dot on the picture of one column against another, at the time of the page.

import { current, onTime } from "./time.js";

// The value of a curve at a time, on the line between its points; null where it has none.
function valueAt({ times, values }, time) {
  const next = times.findIndex((other) => other >= time);
  if (next <= 0) {
    return values[next === 0 ? 0 : values.length - 1];
  }
  const [before, after] = [values[next - 1], values[next]];
  if (before === null || after === null) {
    return null;
  }
  const part = (time - times[next - 1]) / (times[next] - times[next - 1]);
  return before + part * (after - before);
}

function place([low, high, from, to], value) {
  return from + ((value - low) / (high - low)) * (to - from);
}

// Follows the time on a picture whose columns are among the curves. Returns what ends that.
export function follow(path, curves, picture) {
  const [x, y] = [curves.get(path.x), curves.get(path.y)];
  if (!x || !y) {
    return () => {};
  }
  const dot = document.createElementNS(picture.namespaceURI, "circle");
  dot.setAttribute("class", "dot");
  dot.setAttribute("r", "5");
  picture.append(dot);
  const mark = (time) => {
    const [across, up] = [valueAt(x, time), valueAt(y, time)];
    dot.style.display = across === null || up === null ? "none" : "";
    if (across !== null && up !== null) {
      dot.setAttribute("cx", place(path.across, across));
      dot.setAttribute("cy", place(path.up, up));
    }
  };
  mark(current() ?? x.times[0]);
  return onTime(mark);
}
