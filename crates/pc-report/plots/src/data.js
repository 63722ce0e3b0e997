// The data of the page: numbers relative to an offset, in single precision, encoded in base 64.

// The numbers; null where there is no value, which leaves a gap in a curve.
function numbers([offset, text]) {
  const bytes = Uint8Array.from(atob(text), (sign) => sign.charCodeAt(0));
  return Array.from(new Float32Array(bytes.buffer), (number) => (Number.isFinite(number) ? offset + number : null));
}

// The charts, each with the id of its figure and its curves, and the paths, each with the ends of its axes.
export function read({ times, charts, paths }) {
  const lists = times.map(numbers);
  const drawn = charts.map((chart) => ({
    ...chart,
    times: lists[chart.times],
    curves: chart.curves.map(([name, ...values]) => ({ name, values: numbers(values) })),
  }));
  return { charts: drawn, paths };
}
