// The plots of the page. Where this script fails or does not run, their pictures stay. A page may also have an element "plots",
// to which it gives plots one after the other, by `document.getElementById("plots").plots.replace(data)`.

import { draw } from "./chart.js";
import { read } from "./data.js";
import { follow } from "./path.js";
import { Places } from "./places.js";
import { onChange } from "./theme.js";

// By their names; drift, in decades, is drawn under the names of what drifts.
function curvesOf(charts) {
  const curves = new Map();
  for (const { times, curves: list } of charts.filter(({ decades }) => !decades)) {
    list.forEach(({ name, values }) => curves.set(name, { times, values }));
  }
  return curves;
}

const given = document.getElementById("plots-data");
if (given) {
  const { charts, paths } = read(JSON.parse(given.textContent));
  const plots = charts.map((chart) => draw(chart, document.getElementById(chart.id)));
  onChange(() => plots.forEach((plot) => plot.redraw()));
  paths.forEach((path) => follow(path, curvesOf(charts), document.querySelector(`#${path.id} svg`)));
  document.getElementById("plots-help").hidden = false;
}

const root = document.getElementById("plots");
if (root) {
  const places = new Places(root);
  onChange(() => places.redraw());
  root.plots = {
    replace: (data) => {
      const { charts, paths } = read(data);
      places.show(charts, paths, curvesOf(charts));
    },
  };
}
