// Round numbers: 1, 2 or 5 times a power of ten.

const STEPS = [1, 2, 5];

// The round numbers from `least` to `most`, in order.
export function roundNumbers(least, most) {
  const found = [];
  for (let power = Math.floor(Math.log10(least)) - 1; power <= Math.ceil(Math.log10(most)); power++) {
    for (const step of STEPS) {
      const number = Number(`${step}e${power}`);
      if (number >= least * (1 - 1e-9) && number <= most * (1 + 1e-9)) {
        found.push(number);
      }
    }
  }
  return found;
}

// The largest round number that is not larger than `x`.
export function roundBelow(x) {
  return roundNumbers(x / 10, x).at(-1) ?? x;
}

// A number as it is written in a label.
export function written(x) {
  return Math.abs(x) >= 1e5 || Math.abs(x) < 1e-4 ? x.toExponential().replace("e+", "e") : String(Number(x.toPrecision(12)));
}

export function clamp(x, least, most) {
  return Math.min(Math.max(x, least), most);
}

// From 0 to 1 as x goes from `start` to `end`, level at both ends.
export function smoothStep(start, end, x) {
  const part = clamp((x - start) / (end - start), 0, 1);
  return part * part * (3 - 2 * part);
}
