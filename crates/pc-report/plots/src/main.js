// The plots of the page. Where this script fails or does not run, their pictures stay.

import { draw } from "./chart.js";
import { read } from "./data.js";
import { follow } from "./path.js";
import { onChange } from "./theme.js";

const { charts, paths } = read(document.getElementById("plots-data").textContent);
const plots = charts.map((chart) => draw(chart, document.getElementById(chart.id)));
onChange(() => plots.forEach((plot) => plot.redraw(false)));

// By their names; drift, in decades, is drawn under the names of what drifts.
const curves = new Map();
for (const { times, curves: list } of charts.filter(({ decades }) => !decades)) {
  list.forEach(({ name, values }) => curves.set(name, { times, values }));
}
paths.forEach((path) => follow(path, curves, document.querySelector(`#${path.id} svg`)));
document.getElementById("plots-help").hidden = false;
