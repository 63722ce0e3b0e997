//! Integrals along a motion, in one call.

use std::borrow::Borrow;
use std::ops::ControlFlow;

use pc_expr::VectorField;

use crate::cvode::integrals::Integrals;
use crate::events::events::NoEvents;
use crate::integration::integration::{Ending, Integration};
use crate::integration::trajectory::Trajectory;
use crate::settings::options::Options;
use crate::solve::failure::SolveFailure;
use crate::solve::solve::Solve;

/// A motion to be integrated together with integrals along it; [`Solve::integrals`] makes it.
#[derive(Debug)]
#[must_use]
pub struct SolveIntegrals<'a, F> {
    field: F,
    t0: f64,
    y0: &'a [f64],
    options: Options,
    integrals: Integrals,
}

impl<'a, F: VectorField, M: Borrow<Options>> Solve<'a, F, M, NoEvents> {
    /// Adds integrals along the motion, from t0 to each output time.
    pub fn integrals(self, integrals: Integrals) -> SolveIntegrals<'a, F> {
        let Solve { field, t0, y0, method, .. } = self;
        SolveIntegrals { field, t0, y0, options: method.borrow().clone(), integrals }
    }
}

impl<F: VectorField> SolveIntegrals<'_, F> {
    /// The states at `times`, and the integrals there.
    ///
    /// # Errors
    /// As for [`Solve::run`].
    pub fn run(self, times: &[f64]) -> Result<(Trajectory, Vec<Vec<f64>>), Box<SolveFailure>> {
        let SolveIntegrals { field, t0, y0, mut options, integrals } = self;
        let mut reached = Trajectory::new(field.dim());
        options.stop_time = options.stop_time.or(times.last().copied().filter(|t| t.is_finite()));
        let mut integration = match Integration::with_integrals(field, t0, y0, &options, integrals) {
            Ok(integration) => integration,
            Err(error) => return Err(Box::new(SolveFailure { reached, error })),
        };
        let mut values = Vec::with_capacity(times.len());
        let result = integration.run_with_integrals(times, |t, y, integrals| {
            reached.push(t, y);
            values.push(integrals.to_vec());
            ControlFlow::Continue(())
        });
        reached.finish(matches!(result, Ok(Ending::Completed)), integration.statistics());
        match result {
            Ok(_) => Ok((reached, values)),
            Err(error) => Err(Box::new(SolveFailure { reached, error })),
        }
    }
}
