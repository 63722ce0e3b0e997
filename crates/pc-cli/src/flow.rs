//! The vector field that is integrated, and what a table shows of its states.

use std::ops::ControlFlow;

use pc_expr::{Backend, Evaluator, Expr, Inputs, Program};
use pc_mech::{LegendreTransform, MechError, Motion, System};
use pc_model::{Assembly, Form, Model, ModelError};
use pc_solve::{
    Ending, HybridMotion, Options, SolveError, SolveFailure, Trajectory, solve_observed,
    solve_with_events_observed,
};

use crate::args::RunForm;
use crate::events::FlowEvents;

/// Equations of motion of a model in one of their forms, tried at the start.
#[derive(Debug)]
pub struct Flow {
    /// The vector field.
    pub motion: Motion,
    /// Its state at the start.
    pub start: Vec<f64>,
    /// Coordinates and declared quasi-velocities, the columns of a table whatever the form.
    pub names: Vec<String>,
    /// What happens where; none in most models.
    pub events: FlowEvents,
    reading: Reading,
    /// The motion with multipliers, where another is integrated: it knows the residuals of the constraints, the reactions,
    /// and the energy of all velocities, which is not that of independent ones.
    watch: Option<Motion>,
}

/// How a state is read as coordinates and all quasi-velocities of the model, and written.
#[derive(Clone, Debug)]
pub struct Reading {
    /// Number of coordinates.
    coordinates: usize,
    /// All quasi-velocities of the model, the declared ones first, as functions of (t, x, η) with the free η.
    quasi_velocities: Evaluator,
    /// Which of them are the free ones.
    free: Vec<usize>,
    parameters: Vec<f64>,
    /// From momenta to quasi-velocities, where the state has momenta.
    transform: Option<LegendreTransform>,
}

impl Reading {
    /// (x, η) with all η of a state.
    ///
    /// # Errors
    /// [`MechError`] where momenta have no quasi-velocities.
    pub fn read(&mut self, t: f64, state: &[f64]) -> Result<Vec<f64>, MechError> {
        match &mut self.transform {
            Some(transform) => {
                let free = transform.to_quasi_velocities(t, state)?;
                Ok(self.complete(t, &free))
            }
            None => Ok(self.complete(t, state)),
        }
    }

    /// (x, η) with all η of one with the free ones.
    fn complete(&mut self, t: f64, free: &[f64]) -> Vec<f64> {
        let n = self.coordinates;
        let mut all = vec![0.0; n + self.quasi_velocities.program().outputs_len()];
        let (coordinates, quasi_velocities) = all.split_at_mut(n);
        coordinates.copy_from_slice(&free[..n]);
        self.quasi_velocities.eval(t, free, &self.parameters, quasi_velocities);
        all
    }

    /// The state of an (x, η) with all η.
    ///
    /// # Errors
    /// [`MechError`] where the quasi-velocities have no momenta.
    pub fn write(&mut self, t: f64, all: &[f64]) -> Result<Vec<f64>, MechError> {
        let (coordinates, eta) = all.split_at(self.coordinates);
        let mut state = coordinates.to_vec();
        state.extend(self.free.iter().map(|&s| eta[s]));
        match &mut self.transform {
            Some(transform) => transform.to_momenta(t, &state),
            None => Ok(state),
        }
    }

    /// The same with other values of the parameters.
    pub(crate) fn with_parameters(&self, parameters: &[f64]) -> Reading {
        Reading { parameters: parameters.to_vec(), ..self.clone() }
    }

    /// Values of the parameters.
    pub fn parameters(&self) -> &[f64] {
        &self.parameters
    }
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
                let free: Vec<Expr<'_>> =
                    all.filter(|eta| compiled.0.names().contains(&eta.to_string())).collect();
                Flow::of(model, assembly, &free, compiled, (None, None))
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
                let watch = if held { Some(model.compile(assembly)?.0) } else { None };
                Flow::of(
                    model,
                    assembly,
                    system.quasi_velocities(),
                    (motion, start),
                    (Some(transform), watch),
                )
            }
        }
    }

    /// The flow of a motion whose state has, or whose momenta have, these free quasi-velocities.
    fn of<'g>(
        model: &Model,
        assembly: &Assembly<'g>,
        free: &[Expr<'g>],
        (motion, start): (Motion, Vec<f64>),
        (transform, watch): (Option<LegendreTransform>, Option<Motion>),
    ) -> Result<Flow, ModelError> {
        let system = &assembly.system;
        let x = system.frame().coordinates();
        let declared = &system.quasi_velocities()[..assembly.declared];
        let all = assembly.quasi_velocities_of(free).map_err(|error| model.constraint_error(error))?;
        let eta = system.quasi_velocities();
        let free_places = free.iter().filter_map(|free| eta.iter().position(|eta| eta == free)).collect();
        let inputs = inputs(system, &[x, free].concat());
        let program = Program::new(system.graph(), &inputs, &all)
            .map_err(|error| model.derivation_error(MechError::from(error)))?;
        let reading = Reading {
            coordinates: x.len(),
            quasi_velocities: Evaluator::new(program, Backend::Interpreter),
            free: free_places,
            parameters: system.parameters().iter().map(|&(_, value)| value).collect(),
            transform,
        };
        Ok(Flow {
            events: FlowEvents::new(model, assembly, &reading, watch.as_ref().unwrap_or(&motion))?,
            motion,
            start,
            names: x.iter().chain(declared).map(ToString::to_string).collect(),
            reading,
            watch,
        })
    }

    /// The motion as far as it can be computed, and why not further.
    pub(crate) fn follow(
        &mut self,
        t_start: f64,
        times: &[f64],
        options: &Options,
        step: impl FnMut(f64, &[f64]) -> ControlFlow<()>,
    ) -> (HybridMotion, Option<SolveError>) {
        let (motion, start) = (&mut self.motion, &self.start);
        if self.events.is_empty() {
            return without_events(solve_observed(motion, t_start, start, times, options, step));
        }
        match solve_with_events_observed(motion, t_start, start, times, options, &mut self.events, step) {
            Ok(motion) => (motion, None),
            Err(failure) => (failure.reached, Some(failure.error)),
        }
    }

    /// The same equations in quasi-velocities with other values of the parameters, at another start.
    pub(crate) fn with_values(&self, parameters: &[f64], start: Vec<f64>) -> Flow {
        let mut motion = self.motion.clone();
        motion.parameters_mut()[..parameters.len()].copy_from_slice(parameters);
        Flow {
            motion,
            start,
            names: self.names.clone(),
            events: self.events.with_parameters(parameters),
            reading: self.reading.with_parameters(parameters),
            watch: None,
        }
    }

    /// Coordinates and all quasi-velocities of a state. Where momenta have no quasi-velocities, these are no numbers.
    fn shown(&mut self, t: f64, state: &[f64]) -> Vec<f64> {
        let n = self.motion.coordinates();
        self.reading.read(t, state).unwrap_or_else(|_| {
            let mut free = state.to_vec();
            free[n..].fill(f64::NAN);
            self.reading.complete(t, &free)
        })
    }

    /// Coordinates and declared quasi-velocities of a state, then the observables.
    pub fn row(&mut self, t: f64, state: &[f64]) -> Vec<f64> {
        let mut row = self.shown(t, state);
        row.extend(match &mut self.watch {
            Some(watch) => watch.observe(t, &row),
            None => self.motion.observe(t, state),
        });
        row.drain(
            self.names.len()
                ..self.motion.coordinates() + self.reading.quasi_velocities.program().outputs_len(),
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

/// Time, a state of these symbols, and the parameters.
pub fn inputs<'g>(system: &System<'g>, state: &[Expr<'g>]) -> Inputs<'g> {
    Inputs {
        time: Some(system.frame().time()),
        state: state.to_vec(),
        parameters: system.parameters().iter().map(|&(symbol, _)| symbol).collect(),
    }
}

/// A motion on which nothing happens, as far as it could be computed, and why not further.
pub(crate) fn without_events(
    solved: Result<Trajectory, Box<SolveFailure>>,
) -> (HybridMotion, Option<SolveError>) {
    let motion = |trajectory, ending| HybridMotion { trajectory, occurrences: Vec::new(), ending };
    match solved {
        Ok(trajectory) if trajectory.is_complete() => (motion(trajectory, Some(Ending::Completed)), None),
        Ok(trajectory) => (motion(trajectory, Some(Ending::Stopped)), None),
        Err(failure) => (motion(failure.reached, None), Some(failure.error)),
    }
}
