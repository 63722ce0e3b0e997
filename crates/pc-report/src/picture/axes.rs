//! Axes with round numbers.

/// An interval of values laid on one of pixels.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Axis {
    pub(crate) low: f64,
    pub(crate) high: f64,
    from: f64,
    to: f64,
}

impl Axis {
    pub(crate) fn new((low, high): (f64, f64), (from, to): (f64, f64)) -> Axis {
        Axis { low, high, from, to }
    }

    /// The place of a value.
    pub(crate) fn place(&self, value: f64) -> f64 {
        self.from + (value - self.low) / (self.high - self.low) * (self.to - self.from)
    }

    /// About `count` multiples of 1, 2 or 5 times a power of ten.
    pub(crate) fn ticks(&self, count: usize) -> Vec<f64> {
        let step = round_step((self.high - self.low) / count as f64);
        let first = (self.low / step).ceil() as i64;
        let last = (self.high / step).floor() as i64;
        if !step.is_finite() || step <= 0.0 || last.saturating_sub(first) > 4 * count as i64 {
            return Vec::new();
        }
        (first..=last).map(|n| n as f64 * step).collect()
    }
}

/// The least of 1, 2, 5 times a power of ten that is not below a length.
fn round_step(length: f64) -> f64 {
    let power = 10f64.powf(length.log10().floor());
    [1.0, 2.0, 5.0, 10.0]
        .map(|n| n * power)
        .into_iter()
        .find(|step| *step >= length * (1.0 - 1e-9))
        .unwrap_or(length)
}

/// The range of some values, a little widened; one about a constant.
pub(crate) fn widened(values: impl Iterator<Item = f64>) -> (f64, f64) {
    let finite = values.filter(|value| value.is_finite());
    let (low, high) = finite.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), v| (l.min(v), h.max(v)));
    if low > high {
        return (0.0, 1.0);
    }
    let margin = 0.05 * (high - low);
    // Less than that is rounding, which would look like noise.
    let margin = if margin > 1e-9 * low.abs().max(high.abs()) { margin } else { 0.1 * high.abs().max(1.0) };
    (low - margin, high + margin)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ticks_are_round() {
        let ticks = |low, high| Axis::new((low, high), (0.0, 1.0)).ticks(5);
        assert_eq!(ticks(0.0, 10.0), [0.0, 2.0, 4.0, 6.0, 8.0, 10.0]);
        assert_eq!(ticks(-0.3, 1.1), [0.0, 0.5, 1.0]);
        assert!(ticks(1.0, 1.0).is_empty() && ticks(0.0, f64::NAN).is_empty());
    }

    #[test]
    fn constants_have_a_range() {
        assert_eq!(widened([3.0, 3.0].into_iter()), (3.0 - 0.3, 3.0 + 0.3));
        assert_eq!(widened([f64::NAN].into_iter()), (0.0, 1.0));
    }
}
