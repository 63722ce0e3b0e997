//! Converts states to coordinates, all quasi-velocities and first-order states of a model.

use pc_expr::{Backend, Evaluator, Expr, Inputs, Program, SymbolPlaces};
use pc_mech::{LegendreTransform, MechError, Signals, System};
use serde::{Deserialize, Serialize};

use crate::assembly::assembly::Assembly;
use crate::diagnostics::error::ModelError;
use crate::flow::free_form::FreeForm;

/// The conversion of a state to coordinates and all quasi-velocities of the model, and back.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(super) struct Reading {
    /// Number of coordinates.
    pub(super) coordinates: usize,
    /// All quasi-velocities of the model, the declared ones first, as functions of (t, x, η, z) with the free η.
    pub(super) quasi_velocities: Evaluator,
    /// The indices of the free quasi-velocities.
    pub(super) free: Vec<usize>,
    pub(super) parameters: Vec<f64>,
    /// The inputs that are functions of time.
    signals: Signals,
    /// The conversion of momenta to quasi-velocities, if the state has momenta.
    pub(super) transform: Option<LegendreTransform>,
    /// Storage space for a state in quasi-velocities.
    pub(super) room: Vec<f64>,
    /// The change of quasi-velocities, if those of the state are not those of the model.
    change: Option<Change>,
}

/// Quasi-velocities of a state that are not those of the model.
#[derive(Clone, Debug, Serialize, Deserialize)]
struct Change {
    /// The values of these quasi-velocities as functions of (t, x, η, z) with the free η.
    written: Evaluator,
    /// The rates of all quasi-velocities of the model as functions of (t, x, η', z, η̇').
    rates: Evaluator,
}

impl Reading {
    /// The conversion of the states of a form, where `all` quasi-velocities are given as functions of the
    /// independent ones.
    ///
    /// # Errors
    /// [`ModelError`] if a symbol has no value.
    pub(super) fn new<'g>(
        assembly: &Assembly<'g>,
        form: &FreeForm<'g>,
        all: &[Expr<'g>],
        transform: Option<LegendreTransform>,
        signals: Signals,
    ) -> Result<Reading, ModelError> {
        let (system, graph) = (&form.system, form.system.graph());
        let known: Vec<_> = form.independent.iter().copied().zip(form.values.iter().copied()).collect();
        let all = graph.substitute(all, &known);
        let compiled = |state: &[Expr<'g>], values: &[Expr<'g>]| {
            let program = Program::new(graph, &inputs(system, state), values);
            let program = assembly.placed(program.map_err(MechError::from))?;
            Ok::<_, ModelError>(Evaluator::new(program, Backend::Interpreter))
        };
        let change = match &form.matrix {
            None => None,
            Some(_) => {
                let (eta, accelerations) = (system.quasi_velocities(), system.accelerations());
                let frame = system.frame();
                let along: Vec<_> = (frame.coordinates().iter().copied().zip(frame.velocities(eta)))
                    .chain(eta.iter().copied().zip(accelerations.iter().copied()))
                    .chain(graph.in_time(frame.time()))
                    .collect();
                let moving = [system.state(), accelerations].concat();
                Some(Change {
                    written: compiled(&system.state_with(&form.independent), &form.definitions)?,
                    rates: compiled(&moving, &graph.directional(&all, &along))?,
                })
            }
        };
        let eta = assembly.system.quasi_velocities();
        let places = SymbolPlaces::of(eta);
        let place = |free: &Expr<'g>| places.get(*free);
        Ok(Reading {
            coordinates: system.frame().coordinates().len(),
            quasi_velocities: compiled(&system.state(), &all)?,
            free: form.independent.iter().filter_map(place).collect(),
            parameters: system.parameters().iter().map(|&(_, value)| value).collect(),
            signals,
            transform,
            room: Vec::new(),
            change,
        })
    }

    /// Whether the quasi-velocities of the state are not those of the model.
    pub(super) fn is_changed(&self) -> bool {
        self.change.is_some()
    }

    /// Whether a state is already (x, η, z) with all η.
    pub(super) fn is_plain(&self) -> bool {
        let all = self.quasi_velocities.program().outputs_len();
        self.transform.is_none() && self.change.is_none() && self.free.iter().copied().eq(0..all)
    }

    /// The rates of all quasi-velocities of the model at a state that changes at these rates; `None` if the
    /// quasi-velocities of the state are those of the model.
    pub(super) fn rates(&mut self, t: f64, state: &[f64], rates: &[f64]) -> Option<Vec<f64>> {
        self.follow(t);
        let change = self.change.as_mut()?;
        let moving = self.coordinates..self.coordinates + self.free.len();
        let state = [state, &rates[moving]].concat();
        let mut values = vec![f64::NAN; change.rates.program().outputs_len()];
        change.rates.eval(t, &state, &self.parameters, &mut values);
        Some(values)
    }

    /// Converts a state to (x, η, z) with all η.
    ///
    /// # Errors
    /// [`MechError`] if no quasi-velocities give these momenta.
    pub(super) fn read(&mut self, t: f64, state: &[f64]) -> Result<Vec<f64>, MechError> {
        let mut all = Vec::new();
        self.read_in(t, state, &mut all)?;
        Ok(all)
    }

    /// Converts a state to (x, η, z) with all η, and writes this to `all`.
    ///
    /// # Errors
    /// As for [`read`](Reading::read).
    pub(super) fn read_in(&mut self, t: f64, state: &[f64], all: &mut Vec<f64>) -> Result<(), MechError> {
        self.follow(t);
        let Some(transform) = &mut self.transform else {
            self.complete(t, state, all);
            return Ok(());
        };
        let mut free = std::mem::take(&mut self.room);
        free.resize(state.len(), 0.0);
        let outcome = transform.to_quasi_velocities_in(t, state, &mut free);
        if outcome.is_ok() {
            self.complete(t, &free, all);
        }
        self.room = free;
        outcome
    }

    /// Converts (x, η, z) with only the free η to (x, η, z) with all η, and writes this to `all`.
    pub(super) fn complete(&mut self, t: f64, free: &[f64], all: &mut Vec<f64>) {
        self.follow(t);
        let n = self.coordinates;
        all.clear();
        all.extend_from_slice(&free[..n]);
        all.resize(n + self.quasi_velocities.program().outputs_len(), 0.0);
        self.quasi_velocities.eval(t, free, &self.parameters, &mut all[n..]);
        all.extend_from_slice(&free[n + self.free.len()..]);
    }

    /// Converts (x, η, z) with all η to a state.
    ///
    /// # Errors
    /// [`MechError`] if the quasi-velocities have no momenta.
    pub(super) fn write(&mut self, t: f64, all: &[f64]) -> Result<Vec<f64>, MechError> {
        self.follow(t);
        let (coordinates, rest) = all.split_at(self.coordinates);
        let (eta, states) = rest.split_at(self.quasi_velocities.program().outputs_len());
        let mut state = coordinates.to_vec();
        state.extend(self.free.iter().map(|&s| eta[s]));
        state.extend_from_slice(states);
        if let Some(change) = &mut self.change {
            let mut eta = vec![f64::NAN; self.free.len()];
            change.written.eval(t, &state, &self.parameters, &mut eta);
            state[self.coordinates..self.coordinates + eta.len()].copy_from_slice(&eta);
        }
        match &mut self.transform {
            Some(transform) => transform.to_momenta(t, &state),
            None => Ok(state),
        }
    }

    /// Gives the inputs their values at t; outside their tables, where no motion goes, they keep the last ones.
    fn follow(&mut self, t: f64) {
        if self.signals.is_empty() || self.signals.show(t, &mut self.parameters).is_err() {
            return;
        }
        if let Some(transform) = &mut self.transform {
            transform.parameters_mut()[..self.parameters.len()].copy_from_slice(&self.parameters);
        }
    }

    /// Gives the parameters new values.
    pub(super) fn set_parameters(&mut self, parameters: &[f64]) {
        self.parameters.copy_from_slice(parameters);
        if let Some(transform) = &mut self.transform {
            transform.parameters_mut()[..parameters.len()].copy_from_slice(parameters);
        }
    }

    /// The values of the parameters, which can be changed.
    pub(super) fn parameters_mut(&mut self) -> &mut [f64] {
        &mut self.parameters
    }

    /// Values of the parameters.
    pub(super) fn parameters(&self) -> &[f64] {
        &self.parameters
    }
}

/// The inputs of a program: time, a state of these symbols, and the parameters.
pub(super) fn inputs<'g>(system: &System<'g>, state: &[Expr<'g>]) -> Inputs<'g> {
    Inputs {
        time: Some(system.frame().time()),
        state: state.to_vec(),
        parameters: system.parameters().iter().map(|&(symbol, _)| symbol).collect(),
    }
}
