//! The motion of the canonical equations by power series in time.

use pc_expr::{Inputs, Program, TaylorSeries};
use pc_mech::{Backend, Canonical};

use crate::error::AnalysisError;

/// The order of the series.
const ORDER: usize = 20;
/// The last terms that are kept, relative to the state.
const LAST: f64 = 1e-17;
/// Components smaller than this fraction of the largest count as so large.
const LEAST: f64 = 1e-3;
/// The largest number of series for one motion.
const MOST_SERIES: usize = 100_000;

/// A motion of the equations (10), (11), continued from series to series.
pub(super) struct SeriesMotion {
    series: TaylorSeries,
    parameters: Vec<f64>,
    t: f64,
    /// (x, y)
    state: Vec<f64>,
}

impl SeriesMotion {
    /// The motion through (x, y) = `state` at time t; `None` where the equations are piecewise, so that one series does not
    /// hold for all times.
    pub(super) fn new(
        canonical: &Canonical<'_>,
        t: f64,
        state: &[f64],
    ) -> Result<Option<SeriesMotion>, AnalysisError> {
        let system = canonical.system();
        let variables = system.frame().coordinates().iter().chain(canonical.momenta()).copied();
        let inputs = Inputs {
            time: Some(system.frame().time()),
            state: variables.collect(),
            parameters: system.parameters().iter().map(|&(symbol, _)| symbol).collect(),
        };
        let rates = [canonical.velocities(), canonical.right_hand_side()].concat();
        let program = Program::new(system.graph(), &inputs, &rates)?;
        let series = TaylorSeries::new(&program, Backend::Interpreter);
        let parameters = system.parameters().iter().map(|&(_, value)| value).collect();
        let is_one = series.branches().is_empty();
        Ok(is_one.then(|| SeriesMotion { series, parameters, t, state: state.to_vec() }))
    }

    /// The state at time t; `None` where the series have no finite terms, or the steps become too short to reach it.
    pub(super) fn at(&mut self, t: f64) -> Option<&[f64]> {
        for _ in 0..MOST_SERIES {
            let left = t - self.t;
            if left == 0.0 {
                return Some(&self.state);
            }
            self.series.expand(self.t, &self.state, &[], &self.parameters, ORDER);
            let length = self.length()?.min(left.abs());
            let step = length.copysign(left);
            for (i, z) in self.state.iter_mut().enumerate() {
                let sum = (1..=ORDER).rev().fold(0.0, |sum, k| step * (sum + self.series.coefficients(k)[i]));
                *z += sum;
            }
            self.t = if length == left.abs() { t } else { self.t + step };
        }
        None
    }

    /// The length of the step after which the last terms are small.
    fn length(&self) -> Option<f64> {
        let largest = self.state.iter().fold(0.0f64, |largest, z| largest.max(z.abs()));
        let mut length = f64::INFINITY;
        for k in [ORDER - 1, ORDER] {
            for (c, z) in self.series.coefficients(k).iter().zip(&self.state) {
                if !c.is_finite() {
                    return None;
                }
                if *c != 0.0 {
                    let size = z.abs().max(LEAST * largest).max(f64::MIN_POSITIVE);
                    length = length.min((LAST * size / c.abs()).powf(1.0 / k as f64));
                }
            }
        }
        (length > 0.0).then_some(length)
    }
}
