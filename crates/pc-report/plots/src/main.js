// The plots of the page. Where this script fails or does not run, their pictures stay.

import { draw } from "./chart.js";
import { read } from "./data.js";
import { onChange } from "./theme.js";

const plots = read(document.getElementById("plots-data").textContent).map((chart) =>
  draw(chart, document.getElementById(chart.id)),
);
onChange(() => plots.forEach((plot) => plot.redraw(false)));
document.getElementById("plots-help").hidden = false;
