//! How an FMU integrates, and over which time.

use pc_expr::Method;
use pc_model::document::Simulation;
use pc_model::{Assembly, Flow, Model, ORDINARY_TOLERANCE, Variables};

use crate::error::FmuError;
use crate::options::{FmuOptions, FmuSolver};

/// The settings of a simulation.
#[derive(Clone, Debug)]
pub(crate) struct Experiment {
    pub(crate) solver: FmuSolver,
    pub(crate) t_start: f64,
    pub(crate) t_end: Option<f64>,
    /// The time between two rows of a table.
    pub(crate) interval: Option<f64>,
    pub(crate) relative: f64,
    /// Names of components of the state with their absolute tolerances.
    absolute: Vec<(String, f64)>,
}

impl Experiment {
    /// # Errors
    /// [`FmuError::Step`]; [`FmuError::Model`] if there are no equations.
    pub(crate) fn new(
        model: &Model,
        assembly: &Assembly<'_>,
        variables: Variables,
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
        let rows = simulation.rows();
        let interval = t_end.map(|t| (t - t_start) / (rows.max(2) - 1) as f64);
        let relative = simulation.relative_tolerance();
        let given = simulation.atol.as_ref().map(|atol| atol.value.clone()).unwrap_or_default();
        let mut flow = Flow::new(model, assembly, variables)?;
        let tolerances =
            flow.absolute_tolerances(&given, (t_start, t_end.unwrap_or(t_start + 1.0)), relative);
        let absolute = flow.motion.names().iter().cloned().zip(tolerances).collect();
        Ok(Experiment { solver, t_start, t_end, interval, relative, absolute })
    }

    /// The absolute tolerance of a component of the state.
    pub(crate) fn absolute(&self, name: &str) -> f64 {
        self.absolute
            .iter()
            .find(|(known, _)| known == name)
            .map_or(ORDINARY_TOLERANCE, |&(_, tolerance)| tolerance)
    }

    /// The scale of a component of the state, as importers want to know it.
    pub(crate) fn nominal(&self, name: &str) -> f64 {
        self.absolute(name) / ORDINARY_TOLERANCE
    }

    /// How long it takes, the scale of small times.
    pub(crate) fn length(&self) -> f64 {
        self.t_end.map_or(1.0, |t| t - self.t_start)
    }
}
