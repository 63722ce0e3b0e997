// The data of the page: numbers relative to an offset, in single precision, encoded in base 64.

// The numbers; null where there is no value, which leaves a gap in a curve.
function numbers([offset, text]) {
  const bytes = Uint8Array.from(atob(text), (sign) => sign.charCodeAt(0));
  return Array.from(new Float32Array(bytes.buffer), (number) => (Number.isFinite(number) ? offset + number : null));
}

// The charts, each with the id of its figure, its times and its curves.
export function read(text) {
  const { times, charts } = JSON.parse(text);
  const lists = times.map(numbers);
  return charts.map((chart) => ({
    id: chart.id,
    label: chart.label,
    decades: chart.decades,
    events: chart.events,
    times: lists[chart.times],
    curves: chart.curves.map(([name, ...values]) => ({ name, values: numbers(values) })),
  }));
}
