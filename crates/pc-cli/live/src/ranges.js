// The ranges of sliders.

import { roundAbove } from "./numbers.js";

const STEPS = 200;

// The range around a value, with the step of the slider: for a parameter from 0 to twice its value, so that what is
// positive, as masses are, stays so; for a start on both sides of its value.
export function rangeOf(value, isStart = false) {
  if (isStart || value === 0) {
    const half = roundAbove(Math.max(1, Math.abs(value)));
    return withStep(value - half, value + half);
  }
  return value > 0 ? withStep(0, 2 * value) : withStep(2 * value, 0);
}

// The range that also contains a value that somebody has typed.
export function widened(range, value) {
  if (value >= range.low && value <= range.high) {
    return range;
  }
  const reach = Math.abs(value) * 0.2;
  return withStep(Math.min(range.low, value - reach), Math.max(range.high, value + reach));
}

function withStep(low, high) {
  const exact = (x) => Number(x.toPrecision(12));
  return { low: exact(low), high: exact(high), step: roundAbove((high - low) / STEPS) };
}

// The multiple of the step nearest to a value, inside the range; the ends belong to it.
export function stepped({ low, high, step }, value) {
  if (value <= low) {
    return low;
  }
  return value >= high ? high : Number((Math.round(value / step) * step).toPrecision(12));
}

// The part of a range that lies below a value, from 0 to 1.
export function partOf({ low, high }, value) {
  return high > low ? Math.min(1, Math.max(0, (value - low) / (high - low))) : 0;
}
