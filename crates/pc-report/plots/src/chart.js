// One chart: curves over time.

import uPlot from "uplot";
import { colour } from "./theme.js";
import { current, onTime, seek } from "./time.js";
import { beside, exponential, powers, value } from "./words.js";

const HEIGHT = 240;
// The width of a chart that is not seen yet.
const HIDDEN = 320;
// A click may tremble by so many pixels; beyond, it is a drag, which zooms.
const TREMBLE = 4;
const FONT = '12px system-ui, "DejaVu Sans", sans-serif';

// Whole decades, with at least one of them in view.
function wholeDecades(_plot, low, high) {
  const from = Math.floor(low ?? 0);
  return [from, Math.max(Math.ceil(high ?? 1), from + 1)];
}

// The range of the values with some room; a constant lies in the middle.
function roomy(_plot, low, high) {
  if (low === null || high === null) {
    return [0, 1];
  }
  const least = 1e-12 * Math.max(Math.abs(low), Math.abs(high));
  const half = high - low > least ? 0.06 * (high - low) : Math.abs(high) / 10 || 1;
  return [low - half, high + half];
}

// The width that the numbers beside the axis need.
function sizeOf(plot, labels, axis) {
  if (!labels) {
    return 44;
  }
  plot.ctx.font = plot.axes[axis].font[0];
  const widest = Math.max(0, ...labels.map((label) => plot.ctx.measureText(label).width / uPlot.pxRatio));
  return Math.max(44, Math.ceil(widest) + 14);
}

function axis(more) {
  return {
    stroke: () => colour("--soft"),
    grid: { stroke: () => colour("--line"), width: 1 },
    ticks: { show: false },
    font: FONT,
    ...more,
  };
}

// The place of the last time that is not after the given one.
function placeOf(times, time) {
  let [low, high] = [0, times.length - 1];
  while (low < high) {
    const middle = Math.ceil((low + high) / 2);
    if (times[middle] <= time) {
      low = middle;
    } else {
      high = middle - 1;
    }
  }
  return low;
}

function drawEvents(plot, events) {
  const { left, top, width, height } = plot.bbox;
  plot.ctx.save();
  plot.ctx.strokeStyle = colour("--soft");
  plot.ctx.lineWidth = uPlot.pxRatio;
  plot.ctx.setLineDash([2 * uPlot.pxRatio, 3 * uPlot.pxRatio]);
  plot.ctx.beginPath();
  for (const event of events) {
    const x = plot.valToPos(event, "x", true);
    if (x >= left && x <= left + width) {
      plot.ctx.moveTo(x, top);
      plot.ctx.lineTo(x, top + height);
    }
  }
  plot.ctx.stroke();
  plot.ctx.restore();
}

// Shows and hides curves by the keyboard as by the mouse.
function makeKeys(plot) {
  plot.root.querySelectorAll(".u-legend .u-series:not(:first-child)").forEach((row, i) => {
    const key = row.querySelector("th");
    const say = () => key.setAttribute("aria-pressed", String(plot.series[i + 1].show));
    key.tabIndex = 0;
    key.setAttribute("role", "button");
    key.title = "Show or hide";
    say();
    key.addEventListener("click", () => setTimeout(say));
    key.addEventListener("keydown", (event) => {
      if (event.key === "Enter" || event.key === " ") {
        event.preventDefault();
        key.click();
      }
    });
  });
}

// A click goes to its time, and so does a finger that moves sideways.
function followPointer(plot) {
  const { over } = plot;
  const time = (event) => {
    const { min, max } = plot.scales.x;
    const at = plot.posToVal(event.clientX - over.getBoundingClientRect().left, "x");
    return Math.min(max, Math.max(min, at));
  };
  let start = null;
  let before = null;
  over.addEventListener("pointerdown", (event) => {
    start = event;
  });
  over.addEventListener("pointermove", (event) => {
    if (start !== null && event.pointerType === "touch") {
      seek(time(event));
    }
  });
  over.addEventListener("click", (event) => {
    if (start !== null && Math.abs(event.clientX - start.clientX) <= TREMBLE) {
      before = event.detail === 1 ? current() : before;
      seek(time(event));
    }
    start = null;
  });
  // The second of two clicks shows the whole again, at the time from before the first.
  over.addEventListener("dblclick", () => seek(before ?? plot.data[0][0]));
  for (const end of ["pointercancel", "pointerleave"]) {
    over.addEventListener(end, () => {
      start = null;
    });
  }
}

// What has to be the same in two charts for one to take the place of the other.
export function kind({ label, decades, curves }) {
  return JSON.stringify([label, decades, curves.map(({ name }) => name)]);
}

const dataOf = ({ times, curves }) => [times, ...curves.map((curve) => curve.values)];

// Puts the chart into its figure, in place of the picture for readers without scripts. Returns how to show other numbers,
// and how to remove it.
export function draw(chart, figure) {
  const { curves, decades } = chart;
  let { times, events } = chart;
  const line = document.createElement("div");
  line.className = "now";

  // The line at the time of the page; while no pointer is over the chart, the legend has the values there.
  function mark(plot) {
    const time = current() ?? times[0];
    const { min, max } = plot.scales.x;
    line.hidden = !(time >= min && time <= max);
    line.style.transform = `translateX(${plot.valToPos(time, "x")}px)`;
    if (!(plot.cursor.left >= 0)) {
      plot.setLegend({ idx: placeOf(times, time) }, false);
    }
  }

  const name = (text) => (number) => (number === null ? "–" : text(number));
  const series = curves.map((curve, i) => ({
    label: curve.name,
    stroke: () => colour(`--c${i % 8}`),
    width: 1.5,
    pxAlign: 0,
    points: { show: false },
    value: (_plot, number) => name(decades ? exponential : value)(number ?? null),
  }));
  const plot = new uPlot(
    {
      width: figure.clientWidth || HIDDEN,
      height: HEIGHT,
      padding: [10, 18, 0, 0],
      series: [{ label: "t", value: (_plot, number) => name(value)(number ?? null) }, ...series],
      scales: { x: { time: false }, y: { range: decades ? wholeDecades : roomy } },
      axes: [
        axis({ size: 26, space: 60, values: (_plot, splits, _axis, _space, step) => beside(splits, step) }),
        axis({
          size: sizeOf,
          gap: 6,
          space: 32,
          incrs: decades ? [1, 2, 5, 10, 20, 50, 100] : undefined,
          values: (_plot, splits, _axis, _space, step) => (decades ? powers(splits) : beside(splits, step)),
        }),
      ],
      cursor: {
        y: false,
        drag: { x: true, y: false, dist: TREMBLE },
        sync: { key: "t", scales: ["x", null] },
        points: { size: 7 },
      },
      legend: { markers: { width: 3, stroke: (_plot, i) => `var(--c${(i - 1) % 8})`, fill: "none" } },
      hooks: {
        drawClear: [(self) => drawEvents(self, events)],
        draw: [mark],
        setCursor: [mark],
      },
    },
    dataOf(chart),
    (self, ready) => {
      figure.append(self.root);
      self.over.append(line);
      ready();
    },
  );
  plot.root.setAttribute("role", "group");
  plot.root.setAttribute("aria-label", chart.label);
  makeKeys(plot);
  followPointer(plot);
  const stop = onTime(() => mark(plot));
  const observer = new ResizeObserver(() => {
    if (figure.clientWidth > 0 && figure.clientWidth !== plot.width) {
      plot.setSize({ width: figure.clientWidth, height: HEIGHT });
    }
  });
  observer.observe(figure);
  figure.classList.add("live");
  return {
    redraw: () => plot.redraw(false),
    // The part of the time that is seen, if that is not all of it.
    zoom: () => {
      const { min, max } = plot.scales.x;
      return min > times[0] || max < times.at(-1) ? { min, max } : null;
    },
    show: (range) => plot.setScale("x", range),
    // A part of the time stays in view if the whole is the same.
    replace: (next) => {
      const { min, max } = plot.scales.x;
      const isSame = next.times[0] === times[0] && next.times.at(-1) === times.at(-1);
      ({ times, events } = next);
      plot.setData(dataOf(next), false);
      plot.setScale("x", isSame ? { min, max } : { min: times[0], max: times.at(-1) });
    },
    remove: () => {
      stop();
      observer.disconnect();
      plot.destroy();
      figure.classList.remove("live");
    },
  };
}
