// Numbers in words.

const ABOVE = { "-": "⁻", 0: "⁰", 1: "¹", 2: "²", 3: "³", 4: "⁴", 5: "⁵", 6: "⁶", 7: "⁷", 8: "⁸", 9: "⁹" };

function signed(text) {
  return text.replace("-", "−");
}

// A power of ten.
function power(exponent) {
  return "10" + Array.from(String(exponent), (sign) => ABOVE[sign]).join("");
}

function scientific(value, digits) {
  const [mantissa, exponent] = value.toExponential(digits).split("e");
  return `${signed(mantissa)}⋅${power(Number(exponent))}`;
}

// A value in a legend.
export function value(number) {
  const size = Math.abs(number);
  if (size !== 0 && (size < 1e-4 || size >= 1e6)) {
    return scientific(number, 4);
  }
  return signed(String(Number(number.toPrecision(6))));
}

// A value of which the decimal logarithm is drawn.
export function exponential(logarithm) {
  return scientific(10 ** logarithm, 1);
}

// The number of decimals that a step such as 0.25 needs.
function decimalsOf(step) {
  const size = Math.max(0, -Math.floor(Math.log10(step) + 1e-9));
  const tenths = step * 10 ** size;
  return Math.abs(tenths - Math.round(tenths)) < 1e-6 ? size : size + 1;
}

// The numbers beside an axis, all with as many decimals as the step between them needs.
export function beside(numbers, step) {
  const largest = Math.max(...numbers.map(Math.abs));
  const decimals = decimalsOf(step);
  if (largest >= 1e6 || decimals > 5) {
    const digits = Math.max(0, Math.floor(Math.log10(largest) + 1e-9) + decimals);
    return numbers.map((number) => (number === 0 ? "0" : scientific(number, Math.min(digits, 8))));
  }
  return numbers.map((number) => signed((number === 0 ? 0 : number).toFixed(decimals)));
}

export function powers(numbers) {
  return numbers.map((number) => power(Math.round(number)));
}
