//! The linearizations of one model, at the chosen state, for any values of its parameters and start.

use std::sync::{Mutex, PoisonError};

use pc_analysis::{AnalysisError, CyclicCoordinates, Linearization, Linearizer, SteadyOptions};
use pc_model::Model;

use crate::error::RunError;
use crate::linear::error::LinearError;
use crate::linear::linearizable::{Linearizable, placed};
use crate::linear::state::{At, Cyclic, StateChoice};

/// Which cyclic coordinates are kept if the options do not say so.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum CyclicChoice {
    /// All are kept at an equilibrium, none for a steady motion.
    OfState,
    /// None is kept, so that the number of components is the same for all values of a parameter.
    None,
}

/// The linearization at the chosen state near a start.
pub(crate) fn near(
    linearizer: &mut Linearizer,
    t: f64,
    start: &[f64],
    state: &StateChoice,
    choice: CyclicChoice,
) -> Result<Linearization, AnalysisError> {
    let mut guess = start.to_vec();
    let mut held = state.hold.clone();
    match state.at {
        At::Start => return linearizer.at(t, start),
        At::Steady => {}
        At::Rest => {
            let moving = linearizer.quasi_velocities();
            guess[moving.clone()].fill(0.0);
            held.extend(linearizer.names()[moving].iter().cloned());
        }
    }
    let options = SteadyOptions::default().fixed(held);
    let kept = CyclicCoordinates::KeptAtRest;
    match (state.cyclic, choice) {
        (Some(Cyclic::Keep), _) => linearizer.steady_with(t, &guess, &options, kept),
        (Some(Cyclic::Drop), _) | (None, CyclicChoice::None) => linearizer.steady(t, &guess, &options),
        (None, CyclicChoice::OfState) => {
            let all = linearizer.steady_with(t, &guess, &options, kept)?;
            if all.cyclic.is_empty() { Ok(all) } else { linearizer.steady(t, &guess, &options) }
        }
    }
}

/// The linearizations of a model for other values of its parameters and of its start.
#[derive(Debug)]
pub(crate) struct Varied {
    t: f64,
    state: StateChoice,
    /// The compiled equations, with the index of each component of the state among the start values; none if other
    /// values may lead to other equations.
    common: Option<(Mutex<Linearizer>, Vec<usize>)>,
}

impl Varied {
    /// Prepares linearizations of a model for values near its own.
    pub(crate) fn of(model: &Model, ground: &Linearizable<'_>, state: &StateChoice) -> Varied {
        let places = ground.places(model);
        Varied {
            t: ground.assembly.t_start,
            state: state.clone(),
            common: places.map(|places| (Mutex::new(ground.linear.linearizer.clone()), places)),
        }
    }

    /// The linearization of the model with other values.
    ///
    /// # Errors
    /// [`RunError`]; if the equations of the model depend on the values, the error is located at the place in the file
    /// that causes it.
    pub(crate) fn linearization(&self, model: &Model) -> Result<Linearization, RunError> {
        let Some((linearizer, places)) = &self.common else {
            let graph = model.graph();
            let mut own = Linearizable::new(model, &graph)?;
            let start = own.linear.start.clone();
            let found = near(&mut own.linear.linearizer, self.t, &start, &self.state, CyclicChoice::None);
            return found.map_err(|error| placed(&own.assembly, error, true));
        };
        // Each value has its own, on whatever thread it is: what was computed before leaves no trace.
        let mut linearizer = linearizer.lock().unwrap_or_else(PoisonError::into_inner).clone();
        let values = model.start()?;
        let parameters: Vec<f64> = model.parameters().map(|(_, value)| value).collect();
        linearizer.set_parameters(&parameters);
        let start: Vec<f64> = places.iter().map(|&place| values[place]).collect();
        let found = near(&mut linearizer, self.t, &start, &self.state, CyclicChoice::None);
        found.map_err(|error| LinearError::of(error, true).into())
    }

    /// The largest number of components that a linearization has: the number at the unchanged start of the
    /// model.
    ///
    /// # Errors
    /// [`RunError`] if the parts of the equations are not defined there.
    pub(crate) fn most_components(&self, ground: &mut Linearizable<'_>) -> Result<usize, RunError> {
        let cyclic = match (self.state.at, self.state.cyclic) {
            (At::Start, _) | (_, Some(Cyclic::Keep)) => CyclicCoordinates::KeptAtRest,
            (At::Steady | At::Rest, _) => CyclicCoordinates::LeftOut,
        };
        let found = ground.linear.linearizer.components(self.t, &ground.linear.start, cyclic);
        found.map_err(|error| placed(&ground.assembly, error, true))
    }
}
