//! How an FMU integrates, and over which time.

use pc_model::document::{Method, Simulation};
use pc_model::{Assembly, Model};

use crate::error::FmuError;
use crate::options::{FmuOptions, FmuSolver};

/// Rows of a table, unless the model says another number.
const SAMPLES: usize = 201;

/// The settings of a simulation.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Experiment {
    pub(crate) solver: FmuSolver,
    pub(crate) t_start: f64,
    pub(crate) t_end: Option<f64>,
    /// The time between two rows of a table.
    pub(crate) interval: Option<f64>,
    pub(crate) relative: f64,
    pub(crate) absolute: f64,
}

impl Experiment {
    /// # Errors
    /// [`FmuError::Step`]
    pub(crate) fn new(
        model: &Model,
        assembly: &Assembly<'_>,
        options: &FmuOptions,
    ) -> Result<Experiment, FmuError> {
        let simulation: &Simulation = &model.document().simulation;
        let solver = options.solver.unwrap_or(match simulation.method.as_ref().map(|method| method.value) {
            Some(Method::Bdf | Method::Auto) => FmuSolver::Radau5,
            Some(Method::Adams | Method::Dop853 | Method::Taylor) | None => FmuSolver::Dop853,
        });
        if let FmuSolver::RungeKutta4 { step } = solver
            && !(step.is_finite() && step > 0.0)
        {
            return Err(FmuError::Step { step });
        }
        let t_start = assembly.t_start;
        // Importers go forward only.
        let t_end = simulation.t_end.as_ref().map(|t| t.value).filter(|&t| t > t_start);
        let rows = simulation.samples.as_ref().map_or(SAMPLES, |samples| samples.value);
        let interval = t_end.map(|t| (t - t_start) / (rows.max(2) - 1) as f64);
        let relative = simulation.rtol.as_ref().map_or(1e-9, |rtol| rtol.value);
        let absolute = simulation.atol.as_ref().map_or(1e-12, |atol| atol.value);
        Ok(Experiment { solver, t_start, t_end, interval, relative, absolute })
    }

    /// How long it takes, the scale of small times.
    pub(crate) fn length(&self) -> f64 {
        self.t_end.map_or(1.0, |t| t - self.t_start)
    }
}
