// The charts of a page that has no pictures of its own: figures under headings, which stay as long as the data have them.

import { draw, kind } from "./chart.js";
import { follow } from "./path.js";
import { portrait } from "./portrait.js";

const PATHS = "Phase portraits and paths";

export class Places {
  constructor(root) {
    this.root = root;
    this.charts = [];
    this.paths = [];
  }

  show(charts, paths, curves) {
    const kinds = charts.map(kind).concat(paths.map(({ x, y }) => JSON.stringify([x, y]))).join();
    if (kinds === this.kinds) {
      this.charts.forEach((shown, i) => shown.replace(charts[i]));
    } else {
      this.build(charts, paths);
      this.kinds = kinds;
    }
    this.ends = endsOf(charts);
    this.paths.forEach(({ stop }) => stop?.());
    paths.forEach((path, i) => {
      const { figure } = this.paths[i];
      const drawn = portrait(path, curves);
      figure.replaceChildren(drawn.picture);
      this.paths[i].stop = follow(drawn.path, curves, drawn.picture);
    });
  }

  build(charts, paths) {
    const zoom = this.charts[0]?.zoom();
    const isSame = this.ends === endsOf(charts);
    this.charts.forEach((chart) => chart.remove());
    this.root.replaceChildren();
    const groups = new Map();
    const place = (title, style = "") => {
      if (!groups.has(title)) {
        const heading = document.createElement("h3");
        heading.textContent = title;
        const group = document.createElement("div");
        group.className = `charts ${style}`;
        this.root.append(heading, group);
        groups.set(title, group);
      }
      const figure = document.createElement("figure");
      groups.get(title).append(figure);
      return figure;
    };
    this.charts = charts.map((chart) => draw(chart, place(chart.label.split(":")[0])));
    this.paths = paths.map(() => ({ figure: place(PATHS, "paths") }));
    if (zoom && isSame) {
      this.charts.forEach((chart) => chart.show(zoom));
    }
  }

  redraw() {
    this.charts.forEach((chart) => chart.redraw());
  }
}

// The first and the last time, in words, to compare.
function endsOf(charts) {
  return charts.map(({ times }) => `${times[0]} ${times.at(-1)}`).join();
}
