//! Equations compiled once for many values of the parameters and the start.

use std::sync::{Mutex, PoisonError};

use pc_mech::VectorField;

use crate::assembly::assembly::Assembly;
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
#[derive(Debug)]
pub struct Prototype {
    flow: Mutex<Flow>,
    /// The index of each component of the state among the start values; `None` if it starts at 0.
    places: Vec<Option<usize>>,
    /// Start values that are not components of the state, because constraints make them vanish.
    vanishing: Vec<usize>,
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
    pub fn of(model: &Model, assembly: &Assembly<'_>, variables: Variables, flow: Flow) -> Option<Prototype> {
        let own =
            variables == Variables::QuasiVelocities && !model.projects_start() && !model.derives_start();
        if !own || !assembly.constraints.redundant().is_empty() {
            return None;
        }
        let names = model.start_names();
        let state = flow.motion.names();
        let places = state.iter().map(|x| names.iter().position(|name| name == x)).collect();
        let vanishing = (0..names.len()).filter(|&i| !state.contains(&names[i])).collect();
        Some(Prototype { flow: Mutex::new(flow), places, vanishing })
    }

    /// The equations with the values of a model that has the same text, at its start at time `t`; `None` if
    /// something about this model has to be examined more closely, by [`Flow::new`].
    pub fn flow(&self, model: &Model, t: f64) -> Option<Flow> {
        let values = model.start().ok()?;
        let start: Vec<f64> =
            self.places.iter().map(|place| place.map_or(0.0, |place| values[place])).collect();
        let parameters: Vec<f64> = model.parameters().map(|(_, value)| value).collect();
        let prototype = self.flow.lock().unwrap_or_else(PoisonError::into_inner);
        let mut flow = prototype.with_values(&parameters, start);
        drop(prototype);
        let start = flow.start.clone();
        flow.motion.keep_from(t, &start).ok()?;
        let mut nearest = flow.start.clone();
        flow.motion.project(t, &mut nearest).ok()?;
        let largest = flow.start.iter().fold(0.0f64, |largest, value| largest.max(value.abs()));
        let near = |(a, b): (&f64, &f64)| (a - b).abs() <= ON_CONSTRAINTS * a.abs() + ROUNDING * largest;
        let on = self.vanishing.iter().all(|&place| values[place] == 0.0)
            && flow.start.iter().zip(&nearest).all(near);
        let mut rate = vec![0.0; nearest.len()];
        flow.motion.rhs(t, &start, &mut rate).ok()?;
        let finite = flow.row(t, &start).iter().chain(&rate).all(|value| value.is_finite());
        (on && finite).then_some(flow)
    }
}
