//! Impacts of joints on their stops.

use pc_expr::{Backend, Evaluator, Failure, Program};
use pc_mech::{ImpulseResponse, MechError};
use serde::{Deserialize, Serialize};

use crate::assembly::assembly::Assembly;
use crate::assembly::event::Impact;
use crate::diagnostics::error::ModelError;
use crate::flow::reading::inputs;

/// A stop is reached where its gap is at most this fraction of the way between the ends.
const REACHED: f64 = 1e-9;
/// A sum below this fraction of its terms is their rounding.
const CANCELS: f64 = 64.0 * f64::EPSILON;
/// A joint is at rest at its stop if its speed is at most this fraction of that of the joint that strikes.
const AT_REST: f64 = 1e-9;
/// The number of rounds in which the impulses of several stops are found, and the relative change that ends them.
const MOST_ROUNDS: usize = 10_000;
const SETTLED: f64 = 1e-16;

/// The rates of gaps, and what impulses along them do: with w = ∂v/∂η of the rate v of a gap and the change a of η by the
/// impulse w, a stop that is struck changes η by
///
///   η⁺ = η⁻ − (1 + e) v⁻ a / (w·a),
///
/// so that v⁺ = −e v⁻. Where joints rest at other stops, the impulses of all of these, none of them negative, keep the
/// joints from passing.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(super) struct Impacts {
    response: ImpulseResponse,
    /// The gap, the way between the ends, v, e and w of each stop.
    stops: Vec<Evaluator>,
    /// The stop that is struck at each event, if it is an impact.
    struck: Vec<Option<usize>>,
    coordinates: usize,
}

/// A stop that is reached, at a state.
struct Reached {
    rate: f64,
    /// The least v⁺.
    least: f64,
    w: Vec<f64>,
    a: Vec<f64>,
    impulse: f64,
}

/// The error for a joint that strikes a stop, but is held by constraints.
#[derive(Debug, thiserror::Error)]
#[error("no impulse stops its joint: constraints determine the velocity of the joint")]
struct Held;

impl Impacts {
    /// The impacts among the events of a model, if there are any.
    ///
    /// # Errors
    /// [`ModelError`] if they cannot be compiled.
    pub(super) fn new(assembly: &Assembly<'_>) -> Result<Option<Impacts>, ModelError> {
        if assembly.events.iter().all(|event| event.impact.is_none()) {
            return Ok(None);
        }
        let system = &assembly.system;
        let response = match assembly.constraints.multipliers() {
            Some(multipliers) => multipliers.impulse_response(),
            None => system.poincare().and_then(|equations| equations.impulse_response()),
        };
        let inputs = inputs(system, &system.state());
        let (mut stops, mut struck) = (Vec::new(), Vec::new());
        for event in &assembly.events {
            struck.push(event.impact.as_ref().map(|_| stops.len()));
            let Some(Impact { rate, restitution, way }) = event.impact else { continue };
            let w = system.graph().gradient(rate, system.quasi_velocities());
            let values = [&[event.when, way, rate, restitution], &w[..]].concat();
            let program = Program::new(system.graph(), &inputs, &values).map_err(MechError::from);
            stops.push(Evaluator::new(assembly.placed(program)?, Backend::Interpreter));
        }
        let (response, coordinates) = (assembly.placed(response)?, system.frame().coordinates().len());
        Ok(Some(Impacts { response, stops, struck, coordinates }))
    }

    pub(super) fn set_parameters(&mut self, parameters: &[f64]) {
        self.response.parameters_mut()[..parameters.len()].copy_from_slice(parameters);
    }

    /// Gives a state (x, η, z) with these parameters the velocities after the impact that an event is; whether the
    /// event is one.
    ///
    /// # Errors
    /// A [`Failure`] if the impulse is not determined.
    pub(super) fn strike(
        &mut self,
        event: usize,
        t: f64,
        state: &mut [f64],
        parameters: &[f64],
    ) -> Result<bool, Failure> {
        let Some(struck) = self.struck[event] else { return Ok(false) };
        let mut reached = self.reached(struck, t, state, parameters)?;
        if reached.is_empty() {
            return Ok(true); // an impact at the same time has turned it back
        }
        balance(&mut reached);
        let moving = self.coordinates..self.coordinates + reached[0].w.len();
        let eta = &mut state[moving];
        let mut terms: Vec<f64> = eta.iter().map(|eta| eta.abs()).collect();
        for stop in &reached {
            for ((eta, term), a) in eta.iter_mut().zip(&mut terms).zip(&stop.a) {
                *eta += stop.impulse * a;
                *term = term.max((stop.impulse * a).abs());
            }
        }
        // What cancels is at rest; constraints would carry its rounding into the velocity of a joint that rests at its stop.
        eta.iter_mut()
            .zip(terms)
            .filter(|(eta, term)| eta.abs() <= CANCELS * term)
            .for_each(|(eta, _)| *eta = 0.0);
        // A single velocity takes its value to the last digit: zero is rest.
        for stop in reached.iter().filter(|stop| stop.impulse > 0.0) {
            let mut moved = stop.w.iter().enumerate().filter(|(_, w)| **w != 0.0);
            if let (Some((s, w)), None) = (moved.next(), moved.next()) {
                eta[s] = stop.least / w;
            }
        }
        Ok(true)
    }

    /// The stop that is struck, first, and others that are reached; none if its joint does not arrive.
    fn reached(
        &mut self,
        struck: usize,
        t: f64,
        state: &[f64],
        parameters: &[f64],
    ) -> Result<Vec<Reached>, Failure> {
        let mut reached: Vec<Reached> = Vec::new();
        let others = (0..self.stops.len()).filter(|&stop| stop != struck);
        for stop in std::iter::once(struck).chain(others) {
            let evaluator = &mut self.stops[stop];
            let mut values = vec![0.0; evaluator.program().outputs_len()];
            evaluator.eval(t, state, parameters, &mut values);
            let (&[gap, way, rate, restitution], w) = values.split_at(4) else { continue };
            let is_struck = stop == struck;
            if is_struck && rate >= 0.0 {
                return Ok(reached);
            }
            if !is_struck && (gap > REACHED * way || gap.is_nan()) {
                continue;
            }
            let rests = reached.first().is_some_and(|first| rate.abs() <= AT_REST * first.rate.abs());
            let least = if rests || rate >= 0.0 { 0.0 } else { -restitution * rate };
            let mut a = w.to_vec();
            self.response.respond(t, state, &mut a).map_err(Failure::fatal)?;
            let eased: f64 = w.iter().zip(&a).map(|(w, a)| w * a).sum();
            match eased > 0.0 {
                true => reached.push(Reached { rate, least, w: w.to_vec(), a, impulse: 0.0 }),
                false if is_struck => return Err(Failure::fatal(Held)),
                false => {} // constraints hold it
            }
        }
        Ok(reached)
    }
}

/// Finds the impulses p ≥ 0 with v⁺ = v⁻ + A p ≥ the least v⁺, and p = 0 where v⁺ is larger, A = w·a; one after the other,
/// as the method of Gauss and Seidel does.
fn balance(reached: &mut [Reached]) {
    let n = reached.len();
    let dot = |w: &[f64], a: &[f64]| w.iter().zip(a).map(|(w, a)| w * a).sum::<f64>();
    let matrix: Vec<Vec<f64>> =
        (0..n).map(|i| (0..n).map(|j| dot(&reached[i].w, &reached[j].a)).collect()).collect();
    let mut rates: Vec<f64> = reached.iter().map(|stop| stop.rate).collect();
    for _ in 0..MOST_ROUNDS {
        let mut is_settled = true;
        for i in 0..n {
            let stop = &mut reached[i];
            let impulse = (stop.impulse + (stop.least - rates[i]) / matrix[i][i]).max(0.0);
            let change = impulse - stop.impulse;
            is_settled &= change.abs() <= SETTLED * impulse;
            stop.impulse = impulse;
            (0..n).for_each(|j| rates[j] += matrix[j][i] * change);
        }
        if is_settled || n == 1 {
            return;
        }
    }
}
