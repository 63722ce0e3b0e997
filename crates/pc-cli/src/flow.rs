//! The vector field that is integrated, and what a table shows of its states.

use pc_expr::{Backend, Evaluator, Expr, Inputs, Program};
use pc_mech::{LegendreTransform, MechError, Motion};
use pc_model::{Assembly, Form, Model, ModelError};

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
    /// All quasi-velocities of the model, the declared ones first, as functions of (t, x, η) with the free η.
    quasi_velocities: Evaluator,
    parameters: Vec<f64>,
    /// From momenta to quasi-velocities, where the state has momenta.
    transform: Option<LegendreTransform>,
    /// The motion with multipliers, where another is integrated: it knows the residuals of the constraints, the reactions,
    /// and the energy of all velocities, which is not that of independent ones.
    watch: Option<Motion>,
}

impl Flow {
    /// The equations in the form that is asked for.
    ///
    /// # Errors
    /// [`ModelError`] if there is no such form, or nothing can be evaluated at the start.
    pub fn new(model: &Model, assembly: &Assembly<'_>, form: RunForm) -> Result<Flow, ModelError> {
        match form {
            RunForm::Poincare => {
                let compiled = model.compile(assembly)?;
                let all = assembly.system.quasi_velocities().iter().copied();
                let free = all.filter(|eta| compiled.0.names().contains(&eta.to_string())).collect();
                Flow::of(model, assembly, free, compiled, None)
            }
            RunForm::Canonical => {
                let refused = |error| model.derivation_error(error);
                let system = assembly.free_system().map_err(|error| model.constraint_error(error))?;
                let held = matches!(assembly.bound.form(), Form::Held(_));
                let system = if held { system.without_observed() } else { system };
                let x = system.frame().coordinates();
                let state = [x, system.quasi_velocities()].concat();
                let start = assembly.start_of(&state);
                let canonical =
                    system.canonical().and_then(|canonical| canonical.with_guess(&start[x.len()..]));
                let canonical = canonical.map_err(refused)?;
                let mut transform = canonical.legendre_transform().map_err(refused)?;
                let start = transform.to_momenta(assembly.t_start, &start).map_err(refused)?;
                let motion = model.compile_canonical(&canonical, assembly.t_start, &start)?;
                let free = system.quasi_velocities().to_vec();
                let mut flow = Flow::of(model, assembly, free, (motion, start), Some(transform))?;
                if held {
                    flow.watch = Some(model.compile(assembly)?.0);
                }
                Ok(flow)
            }
        }
    }

    /// The flow of a motion whose state has, or whose momenta have, these free quasi-velocities.
    fn of<'g>(
        model: &Model,
        assembly: &Assembly<'g>,
        free: Vec<Expr<'g>>,
        (motion, start): (Motion, Vec<f64>),
        transform: Option<LegendreTransform>,
    ) -> Result<Flow, ModelError> {
        let system = &assembly.system;
        let x = system.frame().coordinates();
        let declared = &system.quasi_velocities()[..assembly.declared];
        let all = assembly.quasi_velocities_of(&free).map_err(|error| model.constraint_error(error))?;
        let inputs = Inputs {
            time: Some(system.frame().time()),
            state: x.iter().copied().chain(free).collect(),
            parameters: system.parameters().iter().map(|&(symbol, _)| symbol).collect(),
        };
        let program = Program::new(system.graph(), &inputs, &all)
            .map_err(|error| model.derivation_error(MechError::from(error)))?;
        Ok(Flow {
            motion,
            start,
            names: x.iter().chain(declared).map(ToString::to_string).collect(),
            quasi_velocities: Evaluator::new(program, Backend::Interpreter),
            parameters: system.parameters().iter().map(|&(_, value)| value).collect(),
            transform,
            watch: None,
        })
    }

    /// Coordinates and all quasi-velocities of a state. Where momenta have no quasi-velocities, these are no numbers.
    fn shown(&mut self, t: f64, state: &[f64]) -> Vec<f64> {
        let n = self.motion.coordinates();
        let mut free = state.to_vec();
        if let Some(transform) = &mut self.transform {
            match transform.to_quasi_velocities(t, state) {
                Ok(state) => free = state,
                Err(_) => free[n..].fill(f64::NAN),
            }
        }
        let mut all = vec![0.0; n + self.quasi_velocities.program().outputs_len()];
        let (coordinates, quasi_velocities) = all.split_at_mut(n);
        coordinates.copy_from_slice(&free[..n]);
        self.quasi_velocities.eval(t, &free, &self.parameters, quasi_velocities);
        all
    }

    /// Coordinates and declared quasi-velocities of a state, then the observables.
    pub fn row(&mut self, t: f64, state: &[f64]) -> Vec<f64> {
        let mut row = self.shown(t, state);
        row.extend(match &mut self.watch {
            Some(watch) => watch.observe(t, &row),
            None => self.motion.observe(t, state),
        });
        row.drain(
            self.names.len()..self.motion.coordinates() + self.quasi_velocities.program().outputs_len(),
        );
        row
    }

    /// The motion that the observables are those of.
    pub fn observed(&self) -> &Motion {
        self.watch.as_ref().unwrap_or(&self.motion)
    }

    /// Names of the constraints held by multipliers, and of those solved for velocities.
    pub fn constraint_names(&self) -> Vec<String> {
        self.observed().constraint_names().to_vec()
    }

    /// What should be zero of each of these.
    pub fn constraint_residuals(&mut self, t: f64, state: &[f64]) -> Vec<f64> {
        let shown = self.shown(t, state);
        match &mut self.watch {
            Some(watch) => watch.constraint_residuals(t, &shown),
            None => self.motion.constraint_residuals(t, state),
        }
    }

    /// Number of quasi-velocities.
    pub fn quasi_velocities(&self) -> usize {
        self.names.len() - self.motion.coordinates()
    }
}
