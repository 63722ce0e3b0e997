//! Integrals along a motion, in one call.

use std::ops::ControlFlow;

use pc_expr::VectorField;

use crate::cvode::integrals::Integrals;
use crate::integration::integration::{Ending, Integration};
use crate::integration::trajectory::Trajectory;
use crate::settings::options::Options;
use crate::solve::failure::SolveFailure;

/// Integrates ẏ = f(t, y) from y(t0) = y0 as [`solve`](crate::solve()) does, with integrals from t0
/// to each output time.
///
/// # Errors
/// As there.
pub fn solve_with_integrals<F: VectorField>(
    field: F,
    t0: f64,
    y0: &[f64],
    times: &[f64],
    options: &Options,
    integrals: Integrals,
) -> Result<(Trajectory, Vec<Vec<f64>>), Box<SolveFailure>> {
    let mut reached = Trajectory::new(field.dim());
    let mut options = options.clone();
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
