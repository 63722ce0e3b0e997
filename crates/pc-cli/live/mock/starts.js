// Parameters and starts with their numbers, as far as these stand in the text.
import { outline } from "../src/outline.js";

export function starts(text) {
  const [parameters, starts] = [[], []];
  const SECTIONS = { parameters, coordinates: starts, quasi_velocities: starts, states: starts };
  for (const { path, key, value, isHeader } of outline(text)) {
    const number = Number(isHeader ? NaN : value.replace(/^"(.*)"$/, "$1") || NaN);
    if (path.length === 1 && path[0] in SECTIONS && Number.isFinite(number)) {
      SECTIONS[path[0]].push({ name: key, value: number });
    }
  }
  return { parameters, starts };
}
