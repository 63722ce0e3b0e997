//! Lyapunov exponents.

use pc_expr::VectorField;

use crate::cvode::forward::sensitivities::Sensitivities;
use crate::error::{InputError, IntegrationError, Reason, SolveError};
use crate::integration::checks::positive;
use crate::integration::integration::Integration;
use crate::lyapunov::orthonormal::{length, orthonormalise};
use crate::settings::options::Options;

/// Options for the computation of Lyapunov exponents.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LyapunovOptions {
    count: usize,
    interval: f64,
    intervals: u32,
    transient: u32,
}

impl LyapunovOptions {
    /// Options for the `count` largest exponents, computed over `intervals` time intervals of
    /// length `interval`.
    ///
    /// The vectors are orthonormalised after each interval, which should be short enough for the
    /// vectors to stay distinct: the difference between the largest and the smallest exponent,
    /// times `interval`, should be below about 10.
    pub fn new(count: usize, interval: f64, intervals: u32) -> Self {
        LyapunovOptions { count, interval, intervals, transient: 0 }
    }

    /// Sets the number of initial intervals that do not count, in which the motion approaches its
    /// attractor and the vectors turn to their final directions; none by default.
    pub fn transient(self, intervals: u32) -> Self {
        LyapunovOptions { transient: intervals, ..self }
    }

    fn validate(&self, dim: usize) -> Result<(), InputError> {
        if !(1..=dim).contains(&self.count) {
            return Err(InputError::Exponents { count: self.count, dim });
        }
        positive("the interval", self.interval)?;
        positive("the number of intervals", f64::from(self.intervals))
    }
}

/// Lyapunov exponents, in descending order as far as they have converged.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Lyapunov {
    /// The exponents, one for each tangent vector, in units of inverse time.
    pub exponents: Vec<f64>,
    /// The mean exponents up to the end of each interval, to see how they converge: entry
    /// `j + k * count` is exponent j after interval k.
    pub history: Vec<f64>,
    /// The end of the motion.
    pub time: f64,
    /// The state at the end of the motion.
    pub state: Vec<f64>,
}

/// The largest Lyapunov exponents of the motion from y(t0) = y0, forward in time.
///
/// Tangent vectors v̇ = (∂f/∂y) v are integrated along the motion over an interval τ, starting from
/// orthonormal vectors, and are then orthonormalised again, V = QR. Then [Benettin, Galgani,
/// Giorgilli, Strelcyn, Meccanica 15 (1980) 9]
/// ```text
/// λ_j = lim 1/(kτ) (ln R_jj⁽¹⁾ + … + ln R_jj⁽ᵏ⁾).
/// ```
/// The volume spanned by the first vectors grows with the sum of their exponents; the sum of all
/// exponents of a flow is its mean divergence. The mean over a finite time converges no faster than
/// 1/t.
///
/// Products with ∂f/∂y are computed as for [`Sensitivities`]; the vectors have to pass the error
/// test with the tolerances of the state. The method restarts at each interval. The initial vectors
/// are fixed and have generic directions.
///
/// ```
/// use pc_solve::{LyapunovOptions, Options, from_fn, lyapunov_exponents};
///
/// // The saddle ẋ = x + y, ẏ = −2y.
/// let saddle = from_fn(2, |_t, y, ydot| {
///     ydot.copy_from_slice(&[y[0] + y[1], -2.0 * y[1]]);
///     Ok(())
/// });
/// let options = LyapunovOptions::new(2, 0.5, 20).transient(20);
/// let lyapunov = lyapunov_exponents(saddle, 0.0, &[0.0, 1.0], &Options::default(), &options)?;
/// assert!((lyapunov.exponents[0] - 1.0).abs() < 1e-6);
/// assert!((lyapunov.exponents[1] + 2.0).abs() < 1e-6);
/// # Ok::<(), pc_solve::SolveError>(())
/// ```
///
/// # Errors
/// [`SolveError::Input`] if the problem or an option is invalid; [`SolveError::Integration`] if the
/// motion fails, with [`Reason::Collapsed`] if the intervals are too long for the vectors to stay
/// distinct.
pub fn lyapunov_exponents<F: VectorField>(
    mut field: F,
    t0: f64,
    y0: &[f64],
    options: &Options,
    lyapunov: &LyapunovOptions,
) -> Result<Lyapunov, SolveError> {
    let dim = field.dim();
    lyapunov.validate(dim)?;
    let LyapunovOptions { count, interval, intervals, transient } = *lyapunov;
    let (mut time, mut state) = (t0, y0.to_vec());
    let mut vectors = first_vectors(dim, count);
    let mut sums = vec![0.0; count];
    let mut history = Vec::new();
    for k in 1..=u64::from(transient) + u64::from(intervals) {
        let end = t0 + k as f64 * interval;
        let lengths = advance(&mut field, options, end, &mut time, &mut state, &mut vectors)?;
        let Some(counted) = k.checked_sub(u64::from(transient)).filter(|&k| k > 0) else { continue };
        for (sum, length) in sums.iter_mut().zip(lengths) {
            *sum += length.ln();
        }
        history.extend(sums.iter().map(|sum| sum / (counted as f64 * interval)));
    }
    let exponents = history[history.len() - count..].to_vec();
    Ok(Lyapunov { exponents, history, time, state })
}

/// Integrates the state and its tangent vectors from `time` to `end`, orthonormalises the vectors,
/// and returns the diagonal of R.
fn advance(
    field: &mut impl VectorField,
    options: &Options,
    end: f64,
    time: &mut f64,
    state: &mut Vec<f64>,
    vectors: &mut Vec<f64>,
) -> Result<Vec<f64>, SolveError> {
    if end == *time {
        return Err(InputError::EndIsStart { t: end }.into());
    }
    let dim = field.dim();
    let tangent = vectors.chunks_exact(dim).fold(Sensitivities::new(), Sensitivities::along);
    let mut options = options.clone();
    options.stop_time = options.stop_time.or(Some(end).filter(|end| end.is_finite()));
    let mut motion = Integration::with_sensitivities(field, *time, state, &options, &tangent)?;
    *state = motion.state_at(end)?.to_vec();
    *vectors = motion.sensitivities()?;
    *time = end;
    let lengths_before: Vec<f64> = vectors.chunks_exact(dim).map(length).collect();
    let lengths = orthonormalise(vectors, dim);
    for (vector, (&length, before)) in lengths.iter().zip(lengths_before).enumerate() {
        // The remaining vector is then mostly rounding error.
        if length.is_nan() || length <= 16.0 * f64::EPSILON * before {
            let reason = Reason::Collapsed { vector };
            let error = IntegrationError { reason, time: end, state: state.clone(), failure: None };
            return Err(SolveError::Integration(Box::new(error)));
        }
    }
    Ok(lengths)
}

/// Orthonormal vectors in generic directions, from the fractional parts of i² times the golden
/// ratio.
fn first_vectors(dim: usize, count: usize) -> Vec<f64> {
    let ratio = (5.0_f64.sqrt() - 1.0) / 2.0;
    let mut vectors: Vec<f64> =
        (1..=dim * count).map(|i| (i as f64 * i as f64 * ratio).fract() - 0.5).collect();
    orthonormalise(&mut vectors, dim);
    vectors
}
