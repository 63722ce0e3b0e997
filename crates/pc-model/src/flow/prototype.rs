//! Equations compiled once for many values of the parameters and the start.

use std::sync::{Mutex, PoisonError};

use pc_expr::{Backend, Evaluator, Events, LaneField};
use pc_mech::VectorField;
use serde::{Deserialize, Serialize};

use crate::assembly::assembly::Assembly;
use crate::assembly::start::written_start;
use crate::diagnostics::error::ModelError;
use crate::flow::flow::Flow;
use crate::model::model::Model;
use crate::variables::Variables;

/// If projection moves each component of a start by at most this fraction, the start satisfies the constraints up to the
/// rounding of its digits. The fraction is a tenth of the deviation at which a model is refused.
const ON_CONSTRAINTS: f64 = 1e-9;
/// A component may also move by this fraction of the largest component: the rounding error of the projection.
const ROUNDING: f64 = 1e-14;

/// The equations of a model, compiled once for all models that differ from it only in numbers.
#[derive(Debug, Serialize, Deserialize)]
pub struct Prototype {
    flow: Mutex<Flow>,
    /// Copies of it that are not in use.
    #[serde(skip)]
    spare: Mutex<Vec<Flow>>,
    /// The start values as they are written, as functions of the parameters.
    written: Mutex<Evaluator>,
    /// The index of each component of the state among the start values; `None` if it starts at 0.
    places: Vec<Option<usize>>,
    /// Start values that are not components of the state, because constraints make them vanish.
    vanishing: Vec<usize>,
}

/// The numbers of a model that differs from others only in these.
#[derive(Clone, Debug, PartialEq)]
pub struct MemberValues {
    /// The values of the parameters.
    pub parameters: Vec<f64>,
    /// The state at the start.
    pub start: Vec<f64>,
}

impl Prototype {
    /// As for [`of`](Prototype::of); also `None` if the model has no equations of motion.
    pub fn new(model: &Model, variables: Variables) -> Option<Prototype> {
        let prototype = |assembly: &Assembly<'_>| {
            Ok(Prototype::of(model, assembly, variables, Flow::new(model, assembly, variables)?))
        };
        model.derived(prototype).unwrap_or_else(|_: ModelError| None)
    }

    /// The prototype of a flow of the model in these variables. `None` if the equations may depend on the start or
    /// on the values of the parameters (because momenta are solved for velocities near the start, or redundant
    /// constraints are left out), or if the start must be solved for.
    pub fn of(
        model: &Model,
        assembly: &Assembly<'_>,
        variables: Variables,
        mut flow: Flow,
    ) -> Option<Prototype> {
        let own =
            variables == Variables::QuasiVelocities && !model.projects_start() && !model.derives_start();
        if !own || !assembly.constraints.redundant().is_empty() {
            return None;
        }
        let names = model.start_names();
        let state = flow.motion.names();
        let places = state.iter().map(|x| names.iter().position(|name| name == x)).collect();
        let vanishing = (0..names.len()).filter(|&i| !state.contains(&names[i])).collect();
        let graph = model.graph();
        let written = Evaluator::new(written_start(model, &graph).ok()?, Backend::Interpreter);
        // What is compiled on first use is compiled here, and shared by all.
        let start = flow.start.clone();
        flow.row(assembly.t_start, &start);
        let (flow, spare) = (Mutex::new(flow), Mutex::default());
        Some(Prototype { flow, spare, written: Mutex::new(written), places, vanishing })
    }

    /// The equations with the values of a model that has the same text, at its start at time `t`; `None` if
    /// something about this model has to be examined more closely, by [`Flow::new`].
    pub fn flow(&self, model: &Model, t: f64) -> Option<Flow> {
        let values = self.values(model, t)?;
        let prototype = self.flow.lock().unwrap_or_else(PoisonError::into_inner);
        let mut flow = prototype.with_values(&values.parameters, values.start.clone());
        drop(prototype);
        fits(&mut flow, t, &values).then_some(flow)
    }

    /// The field of a model that has the same text, for [lanes](VectorField::lanes), with its values; `None` where
    /// [`flow`](Prototype::flow) is, and if the motion has events or cannot be integrated in lanes.
    pub fn lane(&self, model: &Model, t: f64) -> Option<(LaneField, MemberValues)> {
        let values = self.values(model, t)?;
        let field = self.with(&values, |flow| {
            let free = flow.events.events().is_empty() && flow.motion.breaks().is_empty();
            let field = if free { flow.motion.lanes() } else { None };
            field.filter(|_| fits(flow, t, &values))
        })?;
        Some((field, values))
    }

    /// Does something with a flow that has these values. The flow is one of those at hand: it may be used only where a motion
    /// leaves nothing behind that a later one would find, as where it is integrated in lanes.
    pub fn with<T>(&self, values: &MemberValues, work: impl FnOnce(&mut Flow) -> T) -> T {
        let spare = || self.spare.lock().unwrap_or_else(PoisonError::into_inner);
        let known = spare().pop();
        let mut flow =
            known.unwrap_or_else(|| self.flow.lock().unwrap_or_else(PoisonError::into_inner).clone());
        flow.set_parameters(&values.parameters);
        flow.start.clone_from(&values.start);
        let done = work(&mut flow);
        spare().push(flow);
        done
    }

    /// The values of a model; `None` if the start is not finite, or does not satisfy the constraints that make quasi-velocities
    /// vanish.
    fn values(&self, model: &Model, t: f64) -> Option<MemberValues> {
        let parameters: Vec<f64> = model.parameters().map(|(_, value)| value).collect();
        let mut written = self.written.lock().unwrap_or_else(PoisonError::into_inner);
        let mut values = vec![f64::NAN; written.program().outputs_len()];
        written.eval(t, &[], &parameters, &mut values);
        drop(written);
        for &(place, value) in model.overridden_starts() {
            values[place] = value;
        }
        let is_known = values.iter().all(|value| value.is_finite())
            && self.vanishing.iter().all(|&place| values[place] == 0.0);
        let start = self.places.iter().map(|place| place.map_or(0.0, |place| values[place])).collect();
        is_known.then_some(MemberValues { parameters, start })
    }
}

/// Whether a flow with these values starts on its constraints, with a row and rates that are finite.
fn fits(flow: &mut Flow, t: f64, MemberValues { start, .. }: &MemberValues) -> bool {
    if flow.motion.keep_from(t, start).is_err() {
        return false;
    }
    let mut nearest = start.clone();
    if flow.motion.project(t, &mut nearest).is_err() {
        return false;
    }
    let largest = start.iter().fold(0.0f64, |largest, value| largest.max(value.abs()));
    let near = |(a, b): (&f64, &f64)| (a - b).abs() <= ON_CONSTRAINTS * a.abs() + ROUNDING * largest;
    let on = start.iter().zip(&nearest).all(near);
    let mut rate = vec![0.0; nearest.len()];
    on && flow.motion.rhs(t, start, &mut rate).is_ok()
        && flow.row(t, start).iter().chain(&rate).all(|value| value.is_finite())
}
