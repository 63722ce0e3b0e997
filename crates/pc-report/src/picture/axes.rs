//! Axes with round numbers.

use pc_print::short;

use crate::picture::panel::Scale;

/// An interval of values mapped to an interval of points.
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

    /// The lowest and the highest value, and the points that represent them.
    pub(crate) fn ends(&self) -> [f64; 4] {
        [self.low, self.high, self.from, self.to]
    }

    /// The point that represents a value.
    pub(crate) fn place(&self, value: f64) -> f64 {
        self.from + (value - self.low) / (self.high - self.low) * (self.to - self.from)
    }

    /// The axis, widened about its middle until one point corresponds to this difference in value.
    pub(crate) fn widened_to(&self, per_point: f64) -> Axis {
        let half = per_point * (self.to - self.from).abs() / 2.0;
        let middle = f64::midpoint(self.low, self.high);
        Axis { low: middle - half, high: middle + half, ..*self }
    }

    /// The difference in value that corresponds to one point.
    pub(crate) fn per_point(&self) -> f64 {
        (self.high - self.low) / (self.to - self.from).abs()
    }

    /// About `count` numbers within the axis, multiples of 1, 2 or 5 times a power of ten.
    pub(crate) fn ticks(&self, count: usize) -> Vec<f64> {
        let step = round_step((self.high - self.low) / count as f64);
        self.multiples(step, count)
    }

    /// Zero, and powers of ten from 10ⁿ on, of either sign.
    fn signed_decades(&self, n: i32, count: usize) -> Vec<(f64, String)> {
        let scale = Scale::SignedDecades(n);
        let step = round_step((self.high - self.low) / count as f64).max(1.0) as i32;
        let most = self.low.abs().max(self.high.abs()).ceil().clamp(0.0, 400.0) as i32;
        let powers = (0..=most).step_by(step.unsigned_abs() as usize).map(|more| n + more);
        let places = powers.flat_map(|exponent| {
            let place = scale.of(10f64.powi(exponent));
            let label = power(f64::from(exponent));
            [(-place, format!("−{label}")), (place, label)]
        });
        // 10ⁿ is near zero.
        let all = [(0.0, "0".to_owned())].into_iter().chain(places.skip(2));
        all.filter(|(place, _)| (self.low..=self.high).contains(place)).collect()
    }

    fn multiples(&self, step: f64, count: usize) -> Vec<f64> {
        let first = (self.low / step).ceil() as i64;
        let last = (self.high / step).floor() as i64;
        if !step.is_finite() || step <= 0.0 || last.saturating_sub(first) > 4 * count as i64 {
            return Vec::new();
        }
        (first..=last).map(|n| n as f64 * step).collect()
    }

    /// About `count` values within the axis, with their labels.
    pub(crate) fn labels(&self, scale: Scale, count: usize) -> Vec<(f64, String)> {
        match scale {
            Scale::Linear => {
                let ticks = self.ticks(count);
                let zero = 1e-9 * (self.high - self.low);
                ticks.into_iter().map(|v| (v, linear(if v.abs() < zero { 0.0 } else { v }))).collect()
            }
            Scale::Angles => self
                .multiples(std::f64::consts::FRAC_PI_2, 4)
                .into_iter()
                .map(|v| {
                    let halves = (v / std::f64::consts::FRAC_PI_2).round() as i64;
                    let label = match halves {
                        0 => "0".to_owned(),
                        1 => "π/2".to_owned(),
                        -1 => "−π/2".to_owned(),
                        2 => "π".to_owned(),
                        -2 => "−π".to_owned(),
                        _ => linear(v),
                    };
                    (v, label)
                })
                .collect(),
            Scale::SignedDecades(n) => self.signed_decades(n, count),
            // A few numbers to each power of ten.
            Scale::Decades if self.high - self.low < 2.5 => {
                let powers = self.low.floor() as i32..=self.high.floor() as i32;
                let numbers = powers.flat_map(|n| [1.0, 2.0, 5.0].map(|m| m * 10f64.powi(n)));
                numbers
                    .map(|v| (v.log10(), linear(v)))
                    .filter(|(v, _)| (self.low - 1e-9..=self.high + 1e-9).contains(v))
                    .collect()
            }
            Scale::Decades => {
                let step = round_step((self.high - self.low) / count as f64).max(1.0);
                self.multiples(step, count).into_iter().map(|v| (v, power(v))).collect()
            }
        }
    }
}

/// The label of a number on an axis.
pub(crate) fn label(value: f64, scale: Scale) -> String {
    match scale {
        Scale::Linear | Scale::Angles => linear(value),
        Scale::Decades => power(value),
        Scale::SignedDecades(n) => linear(value.signum() * 10f64.powi(n) * (10f64.powf(value.abs()) - 1.0)),
    }
}

fn linear(value: f64) -> String {
    short(value, 5).replace('-', "−")
}

/// The text for 10 raised to an integer power.
fn power(exponent: f64) -> String {
    let raised = |c: char| match c {
        '-' => '⁻',
        c => c
            .to_digit(10)
            .map_or(c, |digit| ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'][digit as usize]),
    };
    format!("10{}", format!("{exponent:.0}").chars().map(raised).collect::<String>())
}

/// The number of the form 1, 2 or 5 times a power of ten whose ratio to a length is nearest to one.
fn round_step(length: f64) -> f64 {
    let power = 10f64.powf(length.log10().floor());
    let between = [(1.0, 2.0), (2.0, 5.0), (5.0, 10.0)];
    let step = between.into_iter().find(|(a, b)| length * length < a * b * power * power);
    step.map_or(10.0 * power, |(step, _)| step * power)
}

/// The range of some values, if any of them is finite.
pub(crate) fn range(values: impl Iterator<Item = f64>) -> Option<(f64, f64)> {
    let finite = values.filter(|value| value.is_finite());
    let (low, high) = finite.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), v| (l.min(v), h.max(v)));
    (low <= high).then_some((low, high))
}

/// The range of some values, slightly widened; if they are constant, a range about the constant.
pub(crate) fn widened(values: impl Iterator<Item = f64>) -> (f64, f64) {
    let Some((low, high)) = range(values) else { return (0.0, 1.0) };
    if is_still(low, high) {
        let margin = 0.1 * high.abs().max(1.0);
        return (low - margin, high + margin);
    }
    let margin = 0.05 * (high - low);
    (low - margin, high + margin)
}

/// Whether values between `low` and `high` count as constant: such small differences are rounding errors,
/// which would look like noise.
pub(crate) fn is_still(low: f64, high: f64) -> bool {
    0.05 * (high - low) <= 1e-9 * low.abs().max(high.abs())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ticks_are_round() {
        let ticks = |low, high| Axis::new((low, high), (0.0, 1.0)).ticks(5);
        assert_eq!(ticks(0.0, 10.0), [0.0, 2.0, 4.0, 6.0, 8.0, 10.0]);
        assert_eq!(ticks(-3.0, 1.4), [-3.0, -2.0, -1.0, 0.0, 1.0]);
        assert!(ticks(1.0, 1.0).is_empty() && ticks(0.0, f64::NAN).is_empty());
    }

    #[test]
    fn labels_are_those_of_the_scale() {
        let labels = |scale, low, high| {
            let all = Axis::new((low, high), (0.0, 1.0)).labels(scale, 5);
            all.into_iter().map(|(_, label)| label).collect::<Vec<_>>()
        };
        assert_eq!(labels(Scale::Linear, -1.0, 1.0), ["−1", "−0.5", "0", "0.5", "1"]);
        assert_eq!(labels(Scale::Angles, -3.2, 3.2), ["−π", "−π/2", "0", "π/2", "π"]);
        assert_eq!(
            labels(Scale::Decades, -12.0, 0.0),
            ["10⁻¹²", "10⁻¹⁰", "10⁻⁸", "10⁻⁶", "10⁻⁴", "10⁻²", "10⁰"]
        );
        assert_eq!(labels(Scale::Decades, 0.0, 1.0), ["1", "2", "5", "10"]);
        assert_eq!(labels(Scale::SignedDecades(-1), -2.1, 1.1), ["0", "−10⁰", "10⁰", "−10¹"]);
    }

    #[test]
    fn constants_have_a_range() {
        assert_eq!(widened([3.0, 3.0].into_iter()), (3.0 - 0.3, 3.0 + 0.3));
        assert_eq!(widened([f64::NAN].into_iter()), (0.0, 1.0));
    }

    #[test]
    fn both_axes_may_have_the_same_scale() {
        let (x, y) = (Axis::new((0.0, 10.0), (0.0, 100.0)), Axis::new((0.0, 1.0), (100.0, 0.0)));
        let y = y.widened_to(x.per_point());
        assert_eq!((y.low, y.high), (0.5 - 5.0, 0.5 + 5.0));
    }
}
