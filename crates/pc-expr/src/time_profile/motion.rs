//! Time and state along a polynomial motion, enclosed near a point.

use super::interval::Interval;
use super::jet::Jet;

/// Room for this many coefficients avoids allocations as orders grow.
const LONGEST: usize = 64;

/// A polynomial motion y(t₀ + s) = Σ_k c_k sᵏ.
#[derive(Clone, Copy, Debug, Default)]
pub struct PolynomialMotion<'a> {
    /// t₀.
    pub start: f64,
    /// c_0, then c_1, …, each of the length of the state.
    pub coefficients: &'a [f64],
}

impl PolynomialMotion<'_> {
    /// The time within `radius` of the point s = `middle`.
    pub(crate) fn time(self, (middle, radius): (f64, f64)) -> Jet {
        Jet::line(around(self.start + middle, radius), 1.0)
    }

    /// Component `i` of `dim` within `radius` of the point s = `middle`: the polynomial is expanded there, in `local`.
    pub(crate) fn component(
        self,
        (i, dim): (usize, usize),
        (middle, radius): (f64, f64),
        local: &mut Vec<f64>,
    ) -> Jet {
        local.clear();
        local.reserve(LONGEST);
        local.extend(self.coefficients.iter().skip(i).step_by(dim));
        for first in 0..local.len() {
            for k in (first..local.len() - 1).rev() {
                local[k] += middle * local[k + 1];
            }
        }
        let c = |k: usize| local.get(k).copied().unwrap_or(0.0);
        let mut spread = [0.0; 3];
        let mut power = 1.0;
        for k in 1..local.len() {
            let order = k as f64;
            // rᵏ⁻¹ |c_k| with the factors of each derivative.
            let term = power * local[k].abs();
            spread[0] += term * radius;
            if k >= 2 {
                spread[1] += order * term;
            }
            if k >= 3 {
                spread[2] += order * (order - 1.0) * if radius > 0.0 { term / radius } else { 0.0 };
            }
            power *= radius;
        }
        Jet {
            value: around(c(0), spread[0]),
            rate: around(c(1), spread[1]),
            bend: around(2.0 * c(2), spread[2]),
        }
    }
}

fn around(value: f64, spread: f64) -> Interval {
    Interval { lo: value - spread, hi: value + spread }
}
