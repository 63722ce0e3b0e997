//! Step length control.
//!
//! The next length is 0.85 h err^(−1/8), between h/3 and 6 h. The source has the factor 0.9, and
//! optionally a power β of the previous error. Both affect how many steps are rejected; each
//! rejected step costs eleven evaluations. For global errors of 1e-8 and 1e-10, 0.85 takes 5 to 15
//! % fewer evaluations than 0.9 for tops, pendulums and orbits; β = 0.02 saves nothing and β = 0.04
//! costs 5 % for orbits with either factor, so β is left out.

use crate::settings::options::Options;
use crate::settings::tolerance::Tolerance;

/// The safety factor on the length predicted from the error.
pub(super) const SAFETY: f64 = 0.85;
/// The maximum ratio of successive step lengths.
pub(super) const GROWTH: f64 = 6.0;
/// The minimum ratio of successive step lengths.
pub(super) const SHRINKING: f64 = 1.0 / 3.0;

/// Tolerances and step lengths; lengths are positive in both directions of time.
#[derive(Debug, Clone)]
pub(super) struct Control {
    pub(super) relative: f64,
    /// The absolute tolerance of each component, padded to a row.
    pub(super) absolute: Vec<f64>,
    pub(super) longest: f64,
    pub(super) shortest: f64,
    /// The length of the first step after a start, if given.
    pub(super) initial: Option<f64>,
    /// The trial length of the next step, if known.
    pub(super) next: Option<f64>,
}

impl Control {
    /// The control for states of `dim` components in rows of length `row`.
    pub(super) fn new(options: &Options, dim: usize, row: usize) -> Control {
        let mut absolute = match &options.absolute_tolerance {
            Tolerance::Scalar(tolerance) => vec![*tolerance; dim],
            Tolerance::Vector(tolerances) => tolerances.clone(),
        };
        absolute.resize(row, 1.0);
        Control {
            relative: options.resolved_tolerance(),
            absolute,
            longest: options.max_step.unwrap_or(f64::INFINITY),
            shortest: options.min_step.unwrap_or(0.0),
            initial: options.initial_step,
            next: options.initial_step,
        }
    }

    /// The error of a step of length h, computed from the sums of its two estimates over n
    /// components; a step is accepted if it is at most 1.
    ///
    /// ```text
    /// |h| e₅² / √(n (e₅² + 0.01 e₃²))
    /// ```
    /// which decreases as h⁸ although the estimates are of lower order [Hairer, Nørsett, Wanner
    /// 1993, II.10].
    pub(super) fn error(h: f64, (fifth, third): (f64, f64), n: usize) -> f64 {
        let both = fifth + 0.01 * third;
        let both = if both <= 0.0 { 1.0 } else { both };
        h.abs() * fifth / (n as f64 * both).sqrt()
    }

    /// The factor by which the length changes after an accepted step with this error.
    pub(super) fn accepted(error: f64) -> f64 {
        (SAFETY / eighth_root(error)).clamp(SHRINKING, GROWTH)
    }

    /// The factor by which the length changes after a rejected step with this error.
    pub(super) fn rejected(error: f64) -> f64 {
        // A NaN does not tell by how much the step was too long.
        if error.is_finite() { (SAFETY / eighth_root(error)).max(SHRINKING) } else { SHRINKING }
    }

    /// rtol |yᵢ| + atolᵢ
    pub(super) fn tolerance(&self, i: usize, y: f64) -> f64 {
        self.relative * y.abs() + self.absolute[i]
    }

    /// √Σ (vᵢ/(rtol |yᵢ| + atolᵢ))²
    pub(super) fn norm(&self, v: &[f64], y: &[f64]) -> f64 {
        let weighed = v.iter().zip(y).enumerate().map(|(i, (v, y))| v / self.tolerance(i, *y));
        weighed.map(|v| v * v).sum::<f64>().sqrt()
    }
}

/// x^(1/8), computed with correctly rounded square roots, so that the result has the same bits on
/// every machine.
fn eighth_root(x: f64) -> f64 {
    x.sqrt().sqrt().sqrt()
}
