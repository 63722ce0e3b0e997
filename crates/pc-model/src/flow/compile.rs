//! The motion of a model, compiled and tried at the start.

use std::sync::Arc;

use pc_mech::{
    Canonical, CompileOptions, KeptIntegrals, MechError, Motion, Multipliers, Signals, VectorField,
};

use crate::assembly::assembly::Assembly;
use crate::assembly::constraint_treatment::ConstraintFormulation;
use crate::diagnostics::error::ModelError;
use crate::diagnostics::meaning::MeaningError;
use crate::model::model::Model;

/// A stage of the work.
const PROGRAM: &str = "the program of the equations";

impl Model {
    /// Compiles the motion of this model and tries it at the start, which is returned with it: (x, η) with the free
    /// quasi-velocities if constraints say that the others vanish, with all otherwise.
    ///
    /// # Errors
    /// [`ModelError`] if it cannot be evaluated there.
    pub fn compile(&self, assembly: &Assembly<'_>) -> Result<(Motion, Vec<f64>), ModelError> {
        self.document().stage(assembly.system.graph(), PROGRAM, || self.compile_formulation(assembly))
    }

    fn compile_formulation(&self, assembly: &Assembly<'_>) -> Result<(Motion, Vec<f64>), ModelError> {
        match assembly.constraints.formulation() {
            ConstraintFormulation::Multipliers(held) => {
                let (compiled, start) =
                    (held.multipliers.compile_for(self.options()), assembly.start.clone());
                self.started(compiled, || held.multipliers.kept(self.kept()), assembly.t_start, start)
            }
            ConstraintFormulation::Free | ConstraintFormulation::Vanishing(_) => {
                let equations = assembly.equations()?;
                let system = equations.system();
                let state = system.state();
                let (compiled, start) = (equations.compile_for(self.options()), assembly.start_of(&state));
                self.started(compiled, || equations.kept(self.kept()), assembly.t_start, start)
            }
        }
    }

    /// Compiles canonical equations of this model and tries them at the start (x, y).
    ///
    /// # Errors
    /// [`ModelError`] if they cannot be evaluated there.
    pub fn compile_canonical(
        &self,
        equations: &Canonical<'_>,
        t_start: f64,
        start: &[f64],
    ) -> Result<Motion, ModelError> {
        self.document().stage(equations.system().graph(), PROGRAM, || {
            let compiled = equations.compile_for(self.options());
            let kept = || equations.kept(self.kept());
            Ok(self.started(compiled, kept, t_start, start.to_vec())?.0)
        })
    }

    /// Compiles the canonical equations of this model with multipliers, and tries them at the start (x, y).
    ///
    /// # Errors
    /// [`ModelError`] if they cannot be evaluated there.
    pub fn compile_in_momenta(
        &self,
        multipliers: &Multipliers<'_>,
        assembly: &Assembly<'_>,
        start: &[f64],
    ) -> Result<Motion, ModelError> {
        self.document().stage(assembly.system.graph(), PROGRAM, || {
            let compiled = multipliers.compile_in_momenta(self.options(), &assembly.start_velocities());
            let kept = || multipliers.kept(self.kept());
            Ok(self.started(compiled, kept, assembly.t_start, start.to_vec())?.0)
        })
    }

    /// The derivative by external forces is part of the Jacobian under them.
    fn options(&self) -> CompileOptions {
        CompileOptions::default()
            .parameter_jacobian(self.differentiates_by_parameters() || !self.external.is_empty())
            .time_derivative(self.differentiates_by_time())
    }

    /// What was compiled, if it can be evaluated at the start, projected to the integrals that are to be kept. These are to be
    /// integrals whatever the external forces.
    fn started(
        &self,
        compiled: Result<Motion, MechError>,
        kept: impl FnOnce() -> Result<KeptIntegrals, MechError>,
        t_start: f64,
        start: Vec<f64>,
    ) -> Result<(Motion, Vec<f64>), ModelError> {
        let refuse = |cause: String| {
            self.document().error(&self.document().energy_place(), MeaningError::SingularStart { cause })
        };
        let mut motion = compiled.map_err(|error| refuse(error.to_string()))?.driven_by(self.signals());
        let mut rate = vec![0.0; start.len()];
        motion.rhs(t_start, &start, &mut rate).map_err(|failure| {
            let error = MechError::from(failure);
            match error.singular_constraint() {
                Some(_) => self.document().constraint_error(error.into()),
                None => refuse(error.to_string()),
            }
        })?;
        if let Some(name) = self.kept().first().filter(|_| !self.parameter_values().tables().is_empty()) {
            let message = format!("`{name}` cannot be kept where inputs change with time");
            let help = "leave it out of `project`, or give the inputs constant values";
            return Err(self
                .document()
                .error(&self.document().kept_place(name), MeaningError::NoForm { message, help }));
        }
        if !self.kept().is_empty() {
            let kept = kept().map_err(|error| self.document().derivation_error(error))?;
            let forces = motion.parameters().len() - self.external.len()..;
            for (i, force) in motion.parameters_mut()[forces.clone()].iter_mut().enumerate() {
                *force = std::f64::consts::PI / (i + 1) as f64; // in balance with nothing that is written
            }
            motion = motion
                .keep(kept, t_start, &start)
                .map_err(|error| self.document().derivation_error(error))?;
            motion.parameters_mut()[forces].fill(0.0);
        }
        Ok((motion, start))
    }

    /// The inputs that have tables.
    pub(crate) fn signals(&self) -> Signals {
        let names: Vec<&str> = self.parameters().map(|(name, _)| name).collect();
        let tables = self.parameter_values().tables().into_iter();
        Signals::new(tables.map(|(place, table)| (names[place], place, Arc::clone(table))))
    }
}
