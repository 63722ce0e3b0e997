//! Derivatives of events and of their resets with respect to time, state and parameters.

use pc_expr::{Backend, Evaluator, Expr, Program};
use pc_mech::MechError;
use serde::{Deserialize, Serialize};

use crate::assembly::assembly::Assembly;
use crate::diagnostics::error::ModelError;
use crate::flow::reading::inputs;
use crate::model::model::Model;

/// For each event, the derivatives with respect to (t, y, p) of its function and of the values that its reset
/// writes, where y = (x, η, z) with the free η; the other η are functions of the free ones.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(super) struct EventSlopes {
    dim: usize,
    /// The number of symbols in (t, y, p).
    symbols: usize,
    events: Vec<Compiled>,
}

/// The components of the state that a reset writes, and the rows of derivatives of the event's function and
/// of these components.
#[derive(Clone, Debug, Serialize, Deserialize)]
struct Compiled {
    places: Vec<usize>,
    rows: Evaluator,
    values: Vec<f64>,
}

/// The derivatives of one event at one state.
pub(super) struct Slopes<'a> {
    dim: usize,
    symbols: usize,
    compiled: &'a Compiled,
}

/// The derivatives of a single function with respect to (t, y, p).
#[derive(Clone, Copy)]
pub(super) struct Row<'a> {
    dim: usize,
    values: &'a [f64],
}

impl EventSlopes {
    /// The derivatives for these free quasi-velocities; `all` quasi-velocities are given as functions of (t,
    /// x, free η, z).
    ///
    /// # Errors
    /// [`ModelError`] if the derivatives cannot be compiled.
    pub(super) fn new<'g>(
        model: &Model,
        assembly: &Assembly<'g>,
        free: &[Expr<'g>],
        all: &[Expr<'g>],
    ) -> Result<EventSlopes, ModelError> {
        let (system, graph) = (&assembly.system, assembly.system.graph());
        let (x, eta) = (system.frame().coordinates(), system.quasi_velocities());
        let states: Vec<Expr<'g>> = system.states().iter().map(|&(z, _)| z).collect();
        let inputs = inputs(system, &[x, free, &states].concat());
        let symbols: Vec<Expr<'g>> =
            inputs.time.iter().chain(&inputs.state).chain(&inputs.parameters).copied().collect();
        let follow: Vec<_> =
            eta.iter().copied().zip(all.iter().copied()).filter(|(eta, value)| eta != value).collect();
        let everything: Vec<Expr<'g>> = [x, eta, &states].concat();
        let events = assembly.events.iter().map(|event| {
            let written = event.resets.iter().filter_map(|&(place, value)| {
                let state = inputs.state.iter().position(|y| *y == everything[place])?;
                Some((state, value))
            });
            let (places, values): (Vec<usize>, Vec<Expr<'g>>) = written.unzip();
            let functions: Vec<Expr<'g>> = [event.when].into_iter().chain(values).collect();
            let functions = graph.substitute(&functions, &follow);
            let rows: Vec<Expr<'g>> =
                functions.iter().flat_map(|&function| graph.gradient(function, &symbols)).collect();
            let program = Program::new(graph, &inputs, &rows);
            let program =
                program.map_err(|error| model.document().derivation_error(MechError::from(error)))?;
            let rows_len = rows.len();
            let rows = Evaluator::new(program, Backend::Interpreter);
            Ok(Compiled { places, rows, values: vec![f64::NAN; rows_len] })
        });
        let events = events.collect::<Result<_, ModelError>>()?;
        Ok(EventSlopes { dim: inputs.state.len(), symbols: symbols.len(), events })
    }

    /// The derivatives of one event.
    pub(super) fn at(&mut self, event: usize, t: f64, y: &[f64], parameters: &[f64]) -> Slopes<'_> {
        let compiled = &mut self.events[event];
        compiled.rows.eval(t, y, parameters, &mut compiled.values);
        Slopes { dim: self.dim, symbols: self.symbols, compiled }
    }
}

impl<'a> Slopes<'a> {
    fn row(&self, i: usize) -> Row<'a> {
        Row { dim: self.dim, values: &self.compiled.values[i * self.symbols..(i + 1) * self.symbols] }
    }

    /// The derivatives of the function.
    pub(super) fn function(&self) -> Row<'a> {
        self.row(0)
    }

    /// For each component that the reset writes, its index in the state and the derivative that `of` takes
    /// from its row.
    pub(super) fn resets(&self, of: impl Fn(Row<'a>) -> f64) -> impl Iterator<Item = (usize, f64)> {
        self.compiled.places.iter().enumerate().map(move |(i, &place)| (place, of(self.row(i + 1))))
    }
}

impl<'a> Row<'a> {
    pub(super) fn by_time(self) -> f64 {
        self.values[0]
    }

    pub(super) fn by_state(self) -> &'a [f64] {
        &self.values[1..=self.dim]
    }

    pub(super) fn by_parameter(self, j: usize) -> f64 {
        self.values[1 + self.dim + j]
    }

    /// The derivative in the direction (τ, v) in time and state.
    pub(super) fn along(self, in_time: f64, v: &[f64]) -> f64 {
        let by_state = self.by_state().iter().zip(v).map(|(slope, v)| slope * v);
        self.by_time() * in_time + by_state.sum::<f64>()
    }
}
