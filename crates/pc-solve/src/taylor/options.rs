//! Options of Taylor's method.

use pc_expr::SeriesField;

use crate::error::SolveError;
use crate::integration::limits::Limits;
use crate::integration::method::IntegrationMethod;
use crate::settings::tolerance::Tolerance;
use crate::taylor::stepper::Taylor;

/// Integration by [`Taylor`]'s method, of fields that are programs.
///
/// The truncation of each step is kept to about rtol |yᵢ| + atolᵢ. The order follows from the relative tolerance and from what an
/// expansion of the field costs.
///
/// ```
/// use pc_expr::{Backend, Graph, Inputs, Program, ProgramField};
/// use pc_solve::{Solve, TaylorOptions};
///
/// let graph = Graph::new();
/// let [x, v] = graph.symbols(["x", "v"]);
/// let inputs = Inputs { time: None, state: vec![x, v], parameters: vec![] };
/// let program = Program::new(&graph, &inputs, &[v, -x])?;
/// let oscillator = ProgramField::new(program, vec![], Backend::Fastest);
/// let options = TaylorOptions::new().relative_tolerance(1e-15);
/// let solution = Solve::new(oscillator, 0.0, &[1.0, 0.0]).method(options).run(&[10.0])?;
/// assert!((solution.trajectory.state(0)[0] - 10.0_f64.cos()).abs() < 1e-14);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct TaylorOptions {
    pub(super) relative_tolerance: f64,
    pub(super) absolute_tolerance: Tolerance,
    pub(super) order: Option<u32>,
    pub(super) max_step: Option<f64>,
    pub(super) stop_time: Option<f64>,
    pub(super) limits: Limits,
}

impl Default for TaylorOptions {
    fn default() -> TaylorOptions {
        TaylorOptions::new()
    }
}

impl TaylorOptions {
    /// A relative tolerance of 1e-9 and an absolute one of 1e-12.
    pub fn new() -> TaylorOptions {
        TaylorOptions {
            relative_tolerance: 1e-9,
            absolute_tolerance: Tolerance::Scalar(1e-12),
            order: None,
            max_step: None,
            stop_time: None,
            limits: Limits::default(),
        }
    }

    /// The relative tolerance, positive; below 1e-16 nothing is gained.
    #[must_use]
    pub fn relative_tolerance(self, relative_tolerance: f64) -> TaylorOptions {
        TaylorOptions { relative_tolerance, ..self }
    }

    /// The absolute tolerance, positive.
    #[must_use]
    pub fn absolute_tolerance(self, absolute_tolerance: impl Into<Tolerance>) -> TaylorOptions {
        TaylorOptions { absolute_tolerance: absolute_tolerance.into(), ..self }
    }

    /// This order, from 2 to 60, instead of the one that costs least.
    #[must_use]
    pub fn order(self, order: u32) -> TaylorOptions {
        TaylorOptions { order: Some(order), ..self }
    }

    /// The greatest length of a step.
    #[must_use]
    pub fn max_step(self, length: f64) -> TaylorOptions {
        TaylorOptions { max_step: Some(length), ..self }
    }

    /// A time beyond which the field is never evaluated.
    #[must_use]
    pub fn stop_time(self, t: f64) -> TaylorOptions {
        TaylorOptions { stop_time: Some(t), ..self }
    }

    /// The limits of the integration.
    #[must_use]
    pub fn limits(self, limits: Limits) -> TaylorOptions {
        TaylorOptions { limits, ..self }
    }
}

impl<F: SeriesField> IntegrationMethod<F> for TaylorOptions {
    type Stepper = Taylor<F>;

    fn begin(&self, field: F, t0: f64, y0: &[f64], stop: Option<f64>) -> Result<Taylor<F>, SolveError> {
        let mut stepper = Taylor::new(field, t0, y0, self)?;
        if let Some(stop) = stop.filter(|t| t.is_finite()) {
            stepper.stop_at(stop);
        }
        Ok(stepper)
    }
}
