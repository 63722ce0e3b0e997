//! Steps of Gragg's, Bulirsch's and Stoer's method: modified midpoint rules, extrapolated to steps of no length.
//! [Hairer, Nørsett & Wanner 1993, II.9]

use super::skip::Skip;

/// Numbers of parts, all even with odd halves: so that the values in the middle have expansions in h², too.
const PARTS: [usize; 6] = [2, 6, 10, 14, 18, 22];
/// The order of the estimated error.
const ORDER: f64 = 11.0;
/// Relative to a component, to a hundredth of the largest or to a thousandth: of the last but one column of the table, whose last
/// is better by some digits.
const TOLERANCE: f64 = 1e-12;

/// A step from y at t, of length h.
#[derive(Clone, Debug)]
pub(super) struct Step {
    pub(super) length: f64,
    start: Vec<f64>,
    start_rates: Vec<f64>,
    middle: Vec<f64>,
    middle_rates: Vec<f64>,
    pub(super) end: Vec<f64>,
    end_rates: Vec<f64>,
    /// The estimated error in tolerances.
    pub(super) error: f64,
}

/// Makes a step by ẏ = f(τ, y) with τ from its start.
pub(super) fn step(
    mut rates: impl FnMut(f64, &[f64]) -> Result<Vec<f64>, Skip>,
    y: &[f64],
    length: f64,
) -> Result<Step, Skip> {
    let moved = |y: &[f64], by: f64, rates: &[f64]| -> Vec<f64> {
        y.iter().zip(rates).map(|(y, rate)| y + by * rate).collect()
    };
    let start_rates = rates(0.0, y)?;
    let (mut ends, mut middles): (Vec<Vec<f64>>, Vec<Vec<f64>>) = (Vec::new(), Vec::new());
    let mut error = f64::INFINITY;
    for (k, &parts) in PARTS.iter().enumerate() {
        let part = length / parts as f64;
        let (mut before, mut now) = (y.to_vec(), moved(y, part, &start_rates));
        let mut middle = now.clone();
        for i in 1..parts {
            let slope = rates(part * i as f64, &now)?;
            let next = moved(&before, 2.0 * part, &slope);
            before = std::mem::replace(&mut now, next);
            if i + 1 == parts / 2 {
                middle.clone_from(&now);
            }
        }
        extrapolate(&mut ends, now, k);
        extrapolate(&mut middles, middle, k);
        if let [.., coarser, finer] = &ends[..] {
            error = distance(coarser, finer, y);
        }
    }
    let last = |mut row: Vec<Vec<f64>>| row.pop().unwrap_or_default();
    let (middle, end) = (last(middles), last(ends));
    let middle_rates = rates(length / 2.0, &middle)?;
    let end_rates = rates(length, &end)?;
    let finite = end.iter().chain(&middle).chain(&end_rates).all(|value| value.is_finite());
    let error = if finite { error } else { f64::INFINITY };
    Ok(Step { length, start: y.to_vec(), start_rates, middle, middle_rates, end, end_rates, error })
}

/// Replaces row k - 1 of the table by row k, whose last entry is the best.
fn extrapolate(row: &mut Vec<Vec<f64>>, value: Vec<f64>, k: usize) {
    let mut new = vec![value];
    for j in 1..=k {
        let ratio = PARTS[k] as f64 / PARTS[k - j] as f64;
        let (finer, coarser) = (&new[j - 1], &row[j - 1]);
        let entry = finer.iter().zip(coarser).map(|(a, b)| a + (a - b) / (ratio * ratio - 1.0));
        new.push(entry.collect());
    }
    *row = new;
}

fn distance(a: &[f64], b: &[f64], y: &[f64]) -> f64 {
    let largest = y.iter().chain(b).fold(0.0, |largest: f64, y| largest.max(y.abs()));
    let of = |((a, b), y): ((&f64, &f64), &f64)| {
        (a - b).abs() / (TOLERANCE * y.abs().max(b.abs()).max(0.01 * largest).max(1e-3))
    };
    a.iter().zip(b).zip(y).map(of).fold(0.0, f64::max)
}

impl Step {
    /// The length that would have the tolerance for its error.
    pub(super) fn better_length(&self) -> f64 {
        let factor = 0.8 * self.error.max(1e-12).powf(-1.0 / ORDER);
        self.length * if factor.is_finite() { factor.clamp(0.2, 2.0) } else { 0.2 }
    }

    /// The polynomial of degree 5 through states and rates at both ends and in the middle, at a part θ of the step.
    pub(super) fn within(&self, theta: f64) -> Vec<f64> {
        let x = 2.0 * theta - 1.0;
        let h = self.length / 2.0;
        let values = |i: usize| [self.start[i], self.middle[i], self.end[i]];
        let slopes = |i: usize| [self.start_rates[i], self.middle_rates[i], self.end_rates[i]];
        let (x2, outer) = (x * x, 1.0 - x * x);
        // Of value 1 and slope 0, or of value 0 and slope 1, at -1, 0 and 1.
        let of_values = [
            0.25 * x2 * (x - 1.0).powi(2) * (4.0 + 3.0 * x),
            outer * outer,
            0.25 * x2 * (x + 1.0).powi(2) * (4.0 - 3.0 * x),
        ];
        let of_slopes = [
            0.25 * x2 * (x - 1.0).powi(2) * (x + 1.0),
            x * outer * outer,
            0.25 * x2 * (x + 1.0).powi(2) * (x - 1.0),
        ];
        (0..self.start.len())
            .map(|i| {
                let (values, slopes) = (values(i), slopes(i));
                (0..3).map(|j| values[j] * of_values[j] + h * slopes[j] * of_slopes[j]).sum()
            })
            .collect()
    }
}
