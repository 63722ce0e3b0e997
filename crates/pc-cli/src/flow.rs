//! The vector field that is integrated, and what a table shows of its states.

use pc_mech::{LegendreTransform, Motion};
use pc_model::{Assembly, Model, ModelError};

use crate::args::RunForm;

/// Equations of motion of a model in one of their forms, tried at the start.
#[derive(Debug)]
pub struct Flow {
    /// The vector field.
    pub motion: Motion,
    /// Its state at the start.
    pub start: Vec<f64>,
    /// Coordinates and declared quasi-velocities, the columns of a table whatever the form.
    pub names: Vec<String>,
    /// The component of each of these in the state; none of those that constraints keep at zero.
    components: Vec<Option<usize>>,
    /// From momenta to quasi-velocities, where the state has momenta.
    transform: Option<LegendreTransform>,
}

impl Flow {
    /// The equations in the form that is asked for.
    ///
    /// # Errors
    /// [`ModelError`] if there is no such form, or nothing can be evaluated at the start.
    pub fn new(model: &Model, assembly: &Assembly<'_>, form: RunForm) -> Result<Flow, ModelError> {
        match form {
            RunForm::Poincare => {
                let (motion, start) = model.compile(assembly)?;
                let components = motion.names().to_vec();
                Ok(Flow::of(assembly, &components, (motion, start), None))
            }
            RunForm::Canonical => {
                let refused = |error| model.derivation_error(error);
                let system = assembly.free_system().map_err(|error| model.constraint_error(error))?;
                let x = system.frame().coordinates();
                let state = [x, system.quasi_velocities()].concat();
                let start = assembly.start_of(&state);
                let canonical =
                    system.canonical().and_then(|canonical| canonical.with_guess(&start[x.len()..]));
                let canonical = canonical.map_err(refused)?;
                let mut transform = canonical.legendre_transform().map_err(refused)?;
                let start = transform.to_momenta(assembly.t_start, &start).map_err(refused)?;
                let motion = model.compile_canonical(&canonical, assembly.t_start, &start)?;
                let components: Vec<String> = state.iter().map(ToString::to_string).collect();
                Ok(Flow::of(assembly, &components, (motion, start), Some(transform)))
            }
        }
    }

    /// The flow of a motion whose state, in quasi-velocities, has these components.
    fn of(
        assembly: &Assembly<'_>,
        components: &[String],
        (motion, start): (Motion, Vec<f64>),
        transform: Option<LegendreTransform>,
    ) -> Flow {
        let system = &assembly.system;
        let declared = &system.quasi_velocities()[..assembly.declared];
        let names: Vec<String> =
            system.frame().coordinates().iter().chain(declared).map(ToString::to_string).collect();
        let components = names.iter().map(|name| components.iter().position(|c| c == name)).collect();
        Flow { motion, start, names, components, transform }
    }

    /// Coordinates and quasi-velocities of a state, then the observables. Where momenta have no quasi-velocities,
    /// these are no numbers, as the observables are none.
    pub fn row(&mut self, t: f64, state: &[f64]) -> Vec<f64> {
        let mut shown = state.to_vec();
        if let Some(transform) = &mut self.transform {
            match transform.to_quasi_velocities(t, state) {
                Ok(state) => shown = state,
                Err(_) => shown[self.motion.coordinates()..].fill(f64::NAN),
            }
        }
        let mut row: Vec<f64> =
            self.components.iter().map(|component| component.map_or(0.0, |i| shown[i])).collect();
        row.extend(self.motion.observe(t, state));
        row
    }

    /// Number of quasi-velocities.
    pub fn quasi_velocities(&self) -> usize {
        self.names.len() - self.motion.coordinates()
    }
}
