//! Integrals along a motion.

use std::fmt;

use pc_expr::Failure;

use crate::error::InputError;
use crate::integration::checks::positive;
use crate::settings::options::Options;
use crate::settings::tolerance::Tolerance;

/// Writes g(t, y) to its last argument.
pub(crate) type Integrands = Box<dyn FnMut(f64, &[f64], &mut [f64]) -> Result<(), Failure> + Send>;

/// Integrals ∫ g(t, y) dt along a motion, for any number of functions g that do not affect it: the
/// work of a force, the length of a path, a mean value.
///
/// The method integrates these integrals like further components of the state, but outside its
/// implicit equations. Steps also have to pass the error test of the integrals unless that test is
/// [switched off](Integrals::error_control).
///
/// ```
/// use pc_solve::{Integration, Integrals, Options, from_fn};
///
/// // ẏ = −y from 1: ∫ y dt = 1 − e^(−t), ∫ y² dt = (1 − e^(−2t))/2.
/// let decay = from_fn(1, |_t, y, ydot| {
///     ydot[0] = -y[0];
///     Ok(())
/// });
/// let integrals = Integrals::new(2, |_t, y, rates| {
///     rates.copy_from_slice(&[y[0], y[0] * y[0]]);
///     Ok(())
/// });
/// let mut motion = Integration::with_integrals(decay, 0.0, &[1.0], &Options::default(), integrals)?;
/// motion.state_at(2.0)?;
/// let found = motion.integrals()?;
/// assert!((found[0] - (1.0 - (-2.0_f64).exp())).abs() < 1e-8);
/// assert!((found[1] - (1.0 - (-4.0_f64).exp()) / 2.0).abs() < 1e-8);
/// # Ok::<(), pc_solve::SolveError>(())
/// ```
pub struct Integrals {
    pub(crate) count: usize,
    pub(crate) integrands: Integrands,
    pub(crate) error_control: bool,
    tolerances: Option<(f64, f64)>,
}

impl fmt::Debug for Integrals {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Integrals")
            .field("count", &self.count)
            .field("error_control", &self.error_control)
            .field("tolerances", &self.tolerances)
            .finish_non_exhaustive()
    }
}

impl Integrals {
    /// `count` integrals, at least 1, of the functions g(t, y), all of which the closure writes to
    /// its last argument.
    pub fn new(
        count: usize,
        integrands: impl FnMut(f64, &[f64], &mut [f64]) -> Result<(), Failure> + Send + 'static,
    ) -> Integrals {
        Integrals { count, integrands: Box::new(integrands), error_control: true, tolerances: None }
    }

    /// Whether steps have to pass the error test of the integrals; if not, the motion is the same
    /// as without them.
    pub fn error_control(self, error_control: bool) -> Integrals {
        Integrals { error_control, ..self }
    }

    /// Sets the relative and absolute tolerance of the integrals, both positive; by default, they
    /// are the relative tolerance of the state and the smallest of its absolute tolerances.
    pub fn tolerances(self, relative: f64, absolute: f64) -> Integrals {
        Integrals { tolerances: Some((relative, absolute)), ..self }
    }

    /// The relative and absolute tolerance, if the input is valid.
    pub(crate) fn validate(&self, options: &Options) -> Result<(f64, f64), InputError> {
        positive("the number of integrals", self.count as f64)?;
        let (relative, absolute) = self.tolerances.unwrap_or_else(|| {
            let least = match &options.absolute_tolerance {
                Tolerance::Scalar(atol) => *atol,
                Tolerance::Vector(atol) => atol.iter().copied().fold(f64::INFINITY, f64::min),
            };
            // An absolute tolerance of 0 would require exact integrals at 0, where they begin.
            let smallest = if least > 0.0 { least } else { options.relative_tolerance };
            (options.relative_tolerance, smallest)
        });
        positive("the relative tolerance of the integrals", relative)?;
        positive("the absolute tolerance of the integrals", absolute)?;
        Ok((relative, absolute))
    }
}
