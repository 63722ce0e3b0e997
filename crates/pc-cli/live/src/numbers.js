// Numbers in words, and numbers read from words.

// A number as short as it can be without rounding errors of decimal steps.
export function written(x) {
  const rounded = Number(x.toPrecision(12));
  const size = Math.abs(rounded);
  return size !== 0 && (size < 1e-4 || size >= 1e7) ? rounded.toExponential().replace("e+", "e") : String(rounded);
}

// What somebody has typed, with a point or a comma; undefined if it is no number.
export function read(text) {
  const plain = text.trim().replace(",", ".").replace("−", "-");
  const number = plain === "" ? NaN : Number(plain);
  return Number.isFinite(number) ? number : undefined;
}

// The least of 1, 2, 5 times a power of ten that is not less than `x`.
export function roundAbove(x) {
  const power = 10 ** Math.floor(Math.log10(x));
  const factor = [1, 2, 5, 10].find((k) => k * power >= x * (1 - 1e-12));
  return Number((factor * power).toPrecision(12));
}

// Milliseconds in words.
export function duration(ms) {
  return ms < 1000 ? `${Math.round(ms)} ms` : `${(ms / 1000).toFixed(ms < 10_000 ? 1 : 0)} s`;
}
