//! The vector field that is integrated, and what a table shows of its states.

use pc_expr::VectorField;
use pc_mech::{Equations, LegendreTransform, Motion};
use pc_model::{Assembly, Model, ModelError};

use crate::args::RunForm;

/// Equations of motion of a model in one of their forms, tried at the start.
#[derive(Debug)]
pub struct Flow {
    /// The vector field.
    pub motion: Motion,
    /// Its state at the start.
    pub start: Vec<f64>,
    /// Coordinates and quasi-velocities, the columns of a table whatever the form.
    pub names: Vec<String>,
    /// From momenta to quasi-velocities, where the state has momenta.
    transform: Option<LegendreTransform>,
}

impl Flow {
    /// The equations in the form that is asked for.
    ///
    /// # Errors
    /// [`ModelError`] if there is no such form, or nothing can be evaluated at the start.
    pub fn new(
        model: &Model,
        assembly: &Assembly<'_>,
        equations: &Equations<'_>,
        form: RunForm,
    ) -> Result<Flow, ModelError> {
        let (t, start) = (assembly.t_start, &assembly.start);
        let system = &assembly.system;
        let symbols = system.frame().coordinates().iter().chain(system.quasi_velocities());
        let names = symbols.map(ToString::to_string).collect();
        match form {
            RunForm::Poincare => Ok(Flow {
                motion: model.compile(equations, t, start)?,
                start: start.clone(),
                names,
                transform: None,
            }),
            RunForm::Canonical => {
                let refused = |error| model.derivation_error(error);
                let eta = &start[system.frame().coordinates().len()..];
                let canonical =
                    system.canonical().and_then(|canonical| canonical.with_guess(eta)).map_err(refused)?;
                let mut transform = canonical.legendre_transform().map_err(refused)?;
                let start = transform.to_momenta(t, start).map_err(refused)?;
                Ok(Flow {
                    motion: model.compile_canonical(&canonical, t, &start)?,
                    start,
                    names,
                    transform: Some(transform),
                })
            }
        }
    }

    /// Coordinates and quasi-velocities of a state, then the observables. Where momenta have no quasi-velocities,
    /// these are no numbers, as the observables are none.
    pub fn row(&mut self, t: f64, state: &[f64]) -> Vec<f64> {
        let mut row = state.to_vec();
        if let Some(transform) = &mut self.transform {
            match transform.to_quasi_velocities(t, state) {
                Ok(state) => row = state,
                Err(_) => row[self.motion.coordinates()..].fill(f64::NAN),
            }
        }
        row.extend(self.motion.observe(t, state));
        row
    }

    /// Number of quasi-velocities.
    pub fn quasi_velocities(&self) -> usize {
        self.motion.dim() - self.motion.coordinates()
    }
}
