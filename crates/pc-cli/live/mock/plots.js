// Data of plots from the table of a run, in the form of those of pc-report: curves of similar size share a chart.

// Numbers relative to the first, in single precision, least significant byte first, in base 64.
function packed(numbers) {
  const offset = numbers.find(Number.isFinite) ?? 0;
  const single = Float32Array.from(numbers, (x) => x - offset);
  return [offset, Buffer.from(single.buffer).toString("base64")];
}

// The table without integrals, in charts by the size of what they show; then paths of neighbours.
export function plots(table) {
  const [head, ...rows] = table.trim().split("\n").map((line) => line.split(","));
  const columns = head.map((name, i) => ({ name, values: rows.map((row) => Number(row[i])) }));
  const [times, ...others] = columns;
  const groups = new Map();
  for (const column of others) {
    const size = Math.max(...column.values.map(Math.abs));
    const span = Math.max(...column.values) - Math.min(...column.values);
    const decade = span === 0 ? "constant" : String(Math.round(Math.log10(size) / 0.7));
    groups.set(decade, [...(groups.get(decade) ?? []), column]);
  }
  const charts = [...groups.values()].map((list, i) => ({
    id: `chart-${i + 1}`,
    label: `Motion: ${list.map(({ name }) => name).join(", ")} over time`,
    decades: false,
    events: [],
    times: 0,
    curves: list.map(({ name, values }) => [name, ...packed(values)]),
  }));
  const moving = others.filter(({ values }) => Math.max(...values) > Math.min(...values));
  const paths = moving.slice(0, 3).map(({ name }, i) => ({ id: `path-${i}`, x: name, y: moving[i + 1]?.name })).filter(({ y }) => y);
  return { times: [packed(times.values)], charts, paths };
}
