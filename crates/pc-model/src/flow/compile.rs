//! The motion of a model, compiled and evaluated at the start.

use std::sync::Arc;

use pc_mech::{
    Canonical, CompileOptions, Equations, EvaluationError, ForceError, KeptIntegrals, MechError, Motion,
    Multipliers, Signals, System, VectorField,
};

use crate::assembly::assembly::Assembly;
use crate::diagnostics::error::ModelError;
use crate::diagnostics::meaning::MeaningError;
use crate::model::model::Model;

/// The name of this stage of the work.
const PROGRAM: &str = "the program of the equations";

impl Model {
    /// Compiles the motion of this model and evaluates it at the start, which is returned with the motion: (x, η)
    /// with the free quasi-velocities if constraints make the others vanish, otherwise with all quasi-velocities.
    ///
    /// # Errors
    /// [`ModelError`] if the motion cannot be evaluated at the start.
    pub fn compile(&self, assembly: &Assembly<'_>) -> Result<(Motion, Vec<f64>), ModelError> {
        self.document().stage(assembly.system.graph(), PROGRAM, || self.compile_formulation(assembly))
    }

    fn compile_formulation(&self, assembly: &Assembly<'_>) -> Result<(Motion, Vec<f64>), ModelError> {
        match assembly.constraints.held() {
            Some(held) => self.compile_multipliers(held, assembly),
            None => {
                let equations = assembly.equations()?;
                let state = equations.system().state();
                self.started_equations(&equations, assembly.t_start, assembly.start_of(&state))
            }
        }
    }

    /// Compiles the equations with multipliers and evaluates them at the start (x, η, z), which contains all
    /// η and is returned with the motion.
    ///
    /// # Errors
    /// [`ModelError`] if the equations cannot be evaluated at the start.
    pub(crate) fn compile_multipliers(
        &self,
        multipliers: &Multipliers<'_>,
        assembly: &Assembly<'_>,
    ) -> Result<(Motion, Vec<f64>), ModelError> {
        let (compiled, start) = (multipliers.compile_for(self.options()), assembly.start.clone());
        self.started(compiled, (self.kept(), || multipliers.kept(self.kept())), assembly.t_start, start)
    }

    fn started_equations(
        &self,
        equations: &Equations<'_>,
        t_start: f64,
        start: Vec<f64>,
    ) -> Result<(Motion, Vec<f64>), ModelError> {
        let (compiled, names) = (equations.compile_for(self.options()), self.kept_of(equations.system()));
        self.started(compiled, (&names, || equations.kept(&names)), t_start, start)
    }

    /// Compiles equations of motion of this model in any independent quasi-velocities, and evaluates them at the start
    /// (x, η, z), which is returned with the motion.
    ///
    /// # Errors
    /// [`ModelError`] if the equations cannot be evaluated at the start.
    pub fn compile_equations(
        &self,
        equations: &Equations<'_>,
        t_start: f64,
        start: Vec<f64>,
    ) -> Result<(Motion, Vec<f64>), ModelError> {
        let compile = || self.started_equations(equations, t_start, start);
        self.document().stage(equations.system().graph(), PROGRAM, compile)
    }

    /// Compiles canonical equations of this model and evaluates them at the start (x, y).
    ///
    /// # Errors
    /// [`ModelError`] if the equations cannot be evaluated at the start.
    pub fn compile_canonical(
        &self,
        equations: &Canonical<'_>,
        t_start: f64,
        start: &[f64],
    ) -> Result<Motion, ModelError> {
        self.document().stage(equations.system().graph(), PROGRAM, || {
            let (compiled, names) = (equations.compile_for(self.options()), self.kept_of(equations.system()));
            let kept = || equations.kept(&names);
            Ok(self.started(compiled, (&names, kept), t_start, start.to_vec())?.0)
        })
    }

    /// Compiles the canonical equations of this model with multipliers, and evaluates them at the start (x,
    /// y).
    ///
    /// # Errors
    /// [`ModelError`] if the equations cannot be evaluated at the start.
    pub fn compile_in_momenta(
        &self,
        multipliers: &Multipliers<'_>,
        assembly: &Assembly<'_>,
        start: &[f64],
    ) -> Result<Motion, ModelError> {
        self.document().stage(assembly.system.graph(), PROGRAM, || {
            let compiled = multipliers.compile_in_momenta(self.options(), &assembly.start_velocities());
            let kept = || multipliers.kept(self.kept());
            Ok(self.started(compiled, (self.kept(), kept), assembly.t_start, start.to_vec())?.0)
        })
    }

    /// The names of the integrals to be kept, without those of the text that do not exist in a system with
    /// fewer coordinates.
    fn kept_of(&self, system: &System<'_>) -> Vec<String> {
        let is_written =
            |name: &String| self.document().integrals.iter().any(|known| known.name.text == *name);
        let is_there = |name: &String| system.integrals().iter().any(|(known, _)| known == name);
        self.kept().iter().filter(|name| is_there(name) || !is_written(name)).cloned().collect()
    }

    /// The options of the compilation. If there are external forces, the derivatives with respect to them are
    /// part of the Jacobian.
    fn options(&self) -> CompileOptions {
        let of_observables = self.differentiates_observables();
        let by_parameters =
            self.differentiates_by_parameters() || of_observables || !self.external.is_empty();
        CompileOptions::default()
            .parameter_jacobian(by_parameters)
            .time_derivative(self.differentiates_by_time())
            .observable_jacobian(of_observables)
    }

    /// The compiled motion, if it can be evaluated at the start, with projection onto the integrals to be
    /// kept. The kept functions have to be integrals whatever the external forces are.
    fn started(
        &self,
        compiled: Result<Motion, MechError>,
        (names, kept): (&[String], impl FnOnce() -> Result<KeptIntegrals, MechError>),
        t_start: f64,
        start: Vec<f64>,
    ) -> Result<(Motion, Vec<f64>), ModelError> {
        let refuse = |error: &MechError| {
            let is_massless =
                matches!(error, MechError::Evaluation(EvaluationError::SingularMassMatrix { .. }));
            let fault = match error {
                MechError::Force(ForceError::TooManySurfaces { .. }) => MeaningError::OfJoint {
                    message: error.to_string(),
                    help: "give fewer joints friction or rigid stops; stops with `stop_stiffness` need no surfaces to stay on",
                },
                _ => MeaningError::SingularStart { cause: error.to_string(), is_massless },
            };
            self.document().error(&self.document().energy_place(), fault)
        };
        let mut motion = compiled.map_err(|error| refuse(&error))?.driven_by(self.signals());
        let mut rate = vec![0.0; start.len()];
        motion.rhs(t_start, &start, &mut rate).map_err(|failure| {
            let error = MechError::from(failure);
            match error.singular_constraint() {
                Some(_) => self.document().constraint_error(error.into()),
                None => refuse(&error),
            }
        })?;
        if let Some(name) = names.first().filter(|_| !self.parameter_values().tables().is_empty()) {
            let message = format!("`{name}` cannot be kept where inputs change with time");
            let help = "leave it out of `project`, or give the inputs constant values";
            return Err(self
                .document()
                .error(&self.document().kept_place(name), MeaningError::NoForm { message, help }));
        }
        if !names.is_empty() {
            let kept = kept().map_err(|error| self.document().derivation_error(error))?;
            let forces = motion.parameters().len() - self.external.len()..;
            for (i, force) in motion.parameters_mut()[forces.clone()].iter_mut().enumerate() {
                *force = std::f64::consts::PI / (i + 1) as f64; // in balance with nothing in the model
            }
            motion = motion
                .keep(kept, t_start, &start)
                .map_err(|error| self.document().derivation_error(error))?;
            motion.parameters_mut()[forces].fill(0.0);
        }
        Ok((motion, start))
    }

    /// The inputs that have tables.
    pub fn signals(&self) -> Signals {
        let names: Vec<&str> = self.parameters().map(|(name, _)| name).collect();
        let tables = self.parameter_values().tables().into_iter();
        Signals::new(tables.map(|(place, table)| (names[place], place, Arc::clone(table))))
    }
}
