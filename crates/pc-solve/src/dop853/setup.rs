//! Construction of the method from a problem and options.

use pc_expr::{Method, VectorField};

use super::arithmetic::padded;
use super::control::Control;
use super::dense::Polynomial;
use super::stages::{Early, Node, Stages};
use super::stiffness::Stiffness;
use crate::error::SolveError;
use crate::foresight::places::Places;
use crate::integration::checks::{check_inequalities, check_start, finite};
use crate::integration::limits::Limits;
use crate::integration::statistics::Statistics;
use crate::settings::options::Options;

/// The explicit Runge–Kutta method of order 8 of Dormand and Prince as a
/// [`Stepper`](crate::Stepper) that owns the vector field.
///
/// ```text
/// kᵢ = f(t + cᵢ h, y + h Σ_{j<i} aᵢⱼ kⱼ), i = 1 … 12;  y(t + h) ≈ y + h Σ bᵢ kᵢ
/// ```
/// with error estimates of orders 5 and 3 and dense output of order 7 [Prince, Dormand 1981;
/// Hairer, Nørsett, Wanner 1993, II.5 and II.6]. It suits non-stiff systems at tolerances of 1e-6
/// and below; stiffness is [detected](Dop853::stiff_from), but the steps then become as short as
/// stability demands. States are [projected](VectorField::project) at the end of each step, and
/// inside steps where they are read. A step in which the field fails recoverably, or that violates
/// an inequality, is repeated with half its length. No step allocates memory, except where f
/// depends on t explicitly and has a turning point within the step.
///
/// ```
/// use pc_solve::{Dop853, Integration, Method, Options, from_fn};
///
/// let oscillator = from_fn(2, |_t, y, ydot| { ydot.copy_from_slice(&[y[1], -y[0]]); Ok(()) });
/// let options = Options::new(Method::Dop853).relative_tolerance(1e-12);
/// let mut motion = Integration::of(Dop853::new(oscillator, 0.0, &[1.0, 0.0], &options)?);
/// assert!((motion.state_at(1.0)?[0] - 1.0_f64.cos()).abs() < 1e-11);
/// # Ok::<(), pc_solve::SolveError>(())
/// ```
#[derive(Debug)]
pub struct Dop853<F> {
    pub(super) field: F,
    pub(super) limits: Limits,
    pub(super) stop_time: Option<f64>,
    pub(super) control: Control,
    pub(super) places: Places,
    pub(super) stiffness: Stiffness,
    /// The start and the end of the last step, and the end of the trial step.
    pub(super) start: Node,
    pub(super) end: Node,
    pub(super) trial: Node,
    /// The stages of the last step and of the trial step.
    pub(super) made: Stages,
    pub(super) tried: Stages,
    pub(super) early: Early,
    /// Room for the argument of a stage, or a state inside a step.
    pub(super) argument: Vec<f64>,
    pub(super) polynomial: Polynomial,
    /// Whether the polynomial is that of the last step.
    pub(super) has_polynomial: bool,
    /// Room for the polynomial coefficients of a motion along a step.
    pub(super) coefficients: Vec<f64>,
    /// Whether the rates at the end of the last step are known.
    pub(super) has_rates: bool,
    /// Whether no step has been made since the start.
    pub(super) begins: bool,
    /// Whether the length of the first step was given.
    pub(super) given: bool,
    pub(super) time: f64,
    /// The step length that was planned before the field changed to another piece.
    pub(super) last_length: Option<f64>,
    pub(super) statistics: Statistics,
}

impl<F: VectorField> Dop853<F> {
    /// Starts at y(t0) = y0, one number per component, with the tolerances, step lengths
    /// and limits of the options; the method they choose is ignored.
    ///
    /// # Errors
    /// [`SolveError::Input`] unless all inputs are finite, of matching lengths and in their ranges;
    /// [`InputError::Explicit`](crate::InputError::Explicit) if the options choose an order, or how
    /// implicit equations are solved.
    pub fn new(field: F, t0: f64, y0: &[f64], options: &Options) -> Result<Self, SolveError> {
        check_start(&field, t0, y0)?;
        Options { method: Method::Dop853, ..options.clone() }.validate(y0.len())?;
        check_inequalities(&field, y0, &options.inequalities)?;
        if let Some(t) = options.stop_time {
            finite("the stop time", t)?;
        }
        Ok(Dop853::of(field, t0, y0, options))
    }

    /// The same with validated input.
    pub(crate) fn of(mut field: F, t0: f64, y0: &[f64], options: &Options) -> Self {
        let row = padded(y0.len());
        let mut y = y0.to_vec();
        y.resize(row, 0.0);
        let node = Node { t: t0, y, rates: vec![0.0; row] };
        let places = Places::new(&mut field, t0, options.min_step);
        Dop853 {
            field,
            limits: options.limits(),
            stop_time: options.stop_time,
            control: Control::new(options, y0.len(), row),
            places,
            stiffness: Stiffness::default(),
            start: node.clone(),
            end: node.clone(),
            trial: node,
            made: std::array::from_fn(|_| vec![0.0; row]),
            tried: std::array::from_fn(|_| vec![0.0; row]),
            early: std::array::from_fn(|_| vec![0.0; row]),
            argument: vec![0.0; row],
            polynomial: Polynomial::new(row),
            has_polynomial: false,
            coefficients: Vec::new(),
            has_rates: false,
            begins: true,
            given: options.initial_step.is_some(),
            time: t0,
            last_length: None,
            statistics: Statistics { current_time: t0, ..Statistics::default() },
        }
    }

    /// The time at which stiffness was first detected, if it was: from about that time on,
    /// stability rather than accuracy limits the steps, and [`Method::Bdf`] can take longer ones.
    pub fn stiff_from(&self) -> Option<f64> {
        self.stiffness.seen
    }

    /// The number of components.
    pub(super) fn dim(&self) -> usize {
        self.field.dim()
    }
}
