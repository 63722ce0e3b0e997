//! The companion of a motion: how it is integrated a second time, more accurately.

use pc_expr::{Method, VectorField};

use crate::integration::statistics::Statistics;
use crate::settings::options::Options;
use crate::settings::tolerance::Tolerance;

/// The tolerance of a companion that uses a method of the same kind, relative to that of the
/// motion.
const FINER: f64 = 1e-3;
/// The tolerance of a companion that uses Taylor's method; its error is then no more than rounding
/// error.
const BY_SERIES: f64 = 1e-16;
/// The smallest tolerance of a companion that uses another method: below it, further steps add more
/// rounding error than the truncation error they remove.
const LEAST: f64 = 1e-15;
/// A motion at a tolerance up to this is as accurate as rounding allows, and so is a motion at
/// [`COARSE`].
const ROUNDING: f64 = 4e-15;
const COARSE: f64 = 1e-14;
/// The maximum number of steps of a companion for each step of the motion.
const MORE_STEPS: u64 = 20;

/// How a motion is integrated a second time, so that the distance between the two is the error of
/// the first motion.
///
/// With the state y of the motion, ỹ of the companion and the true state y*, |y − ỹ| = |y − y*|
/// (1 + O(|ỹ − y*|/|y − y*|)): the companion has to be several times more accurate.
/// - A motion that is not stiff, and whose field has a [series](VectorField::series), has a
///   companion integrated with [`Method::Taylor`] at rtol 10⁻¹⁶, or at a thousandth of the motion's
///   tolerance if that is less: the states of the companion carry their rounding errors along. If
///   the motion itself uses Taylor's method at such a tolerance, the errors of both are rounding
///   errors, made along different steps, and the distance is of the size of these errors.
/// - Any other motion has a companion at a thousandth of its tolerance, but at least 10⁻¹⁵,
///   integrated with [`Method::Auto`], or with [`Method::Bdf`] if the motion uses that method. For
///   a motion at rtol below 4·10⁻¹⁵ the companion is no better: at 10⁻¹⁴ the errors of both are
///   rounding errors.
///
/// Absolute tolerances are reduced by the same factor.
#[derive(Debug, Clone, PartialEq)]
pub struct Companion {
    options: Options,
}

impl Companion {
    /// The companion of a motion of `field` that was integrated with these options and took `work`.
    pub fn of<F: VectorField>(field: &mut F, options: &Options, work: &Statistics) -> Companion {
        let is_stiff = options.method == Method::Bdf || work.stiff_from.is_some() || work.implicit_steps > 0;
        let rtol = options.relative_tolerance;
        if !is_stiff && field.series().is_ok() {
            return Companion::by(Method::Taylor, BY_SERIES.min(FINER * rtol), options);
        }
        let finer = if rtol > ROUNDING { (FINER * rtol).max(LEAST) } else { COARSE };
        Companion::by(implicit(options.method), finer, options)
    }

    fn by(method: Method, rtol: f64, motion: &Options) -> Companion {
        let ratio = rtol / motion.relative_tolerance;
        let absolute = match &motion.absolute_tolerance {
            Tolerance::Scalar(tolerance) => Tolerance::Scalar(ratio * tolerance),
            Tolerance::Vector(all) => Tolerance::Vector(all.iter().map(|one| ratio * one).collect()),
        };
        let keeps_solver = method == motion.method;
        let options = Options {
            method,
            nonlinear_solver: motion.nonlinear_solver.filter(|_| keeps_solver),
            #[cfg(feature = "cvode")]
            linear_solver: motion.linear_solver.clone().filter(|_| method != Method::Taylor),
            relative_tolerance: rtol,
            absolute_tolerance: absolute,
            max_steps: motion.max_steps.saturating_mul(MORE_STEPS),
            // Those of the motion suit its tolerance and its method.
            initial_step: None,
            min_step: None,
            max_order: motion.max_order.filter(|_| keeps_solver && method == Method::Bdf),
            ..motion.clone()
        };
        Companion { options }
    }

    /// Its options.
    pub fn options(&self) -> &Options {
        &self.options
    }

    /// Its method.
    pub fn method(&self) -> Method {
        self.options.method
    }

    /// The relative tolerance of the companion.
    pub fn relative_tolerance(&self) -> f64 {
        self.options.relative_tolerance
    }
}

/// The method used, at a finer tolerance, for the companion of a motion that may be stiff.
#[cfg(feature = "cvode")]
fn implicit(method: Method) -> Method {
    if method == Method::Bdf { Method::Bdf } else { Method::Auto }
}

#[cfg(not(feature = "cvode"))]
fn implicit(_: Method) -> Method {
    Method::Dop853
}
