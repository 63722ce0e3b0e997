//! Linear equations near states that satisfy the constraints, in independent components.

use std::ffi::CString;

use ::pc_model::{Assembly, Model};
use pc_analysis::{AnalysisError, CyclicCoordinates, Linearization, Linearizer, SteadyOptions};
use pc_expr::Evaluator;
use pc_mech::{Expr, MechError, Neighbourhood};
use pc_print::{LinearModel, integrals_of};

use crate::ffi::call_error::CallError;
use crate::machinery::mechanics::evaluate;

/// About which state the equations are linearised.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum About {
    /// The state itself.
    State,
    /// The steady motion near it.
    Steady,
    /// The equilibrium near it.
    Rest,
}

/// The linearizer of a model for some inputs, with what converts states of the system to its states and back.
#[derive(Clone)]
pub(crate) struct Linear {
    /// The parameters among the inputs, by their indices; all external forces come before them.
    inputs: Vec<usize>,
    linearizer: Linearizer,
    /// For each component of the linearizer's state, its index in the state of the system.
    places: Vec<usize>,
    /// All quasi-velocities, from t, the linearizer's state and the parameters.
    velocities: Evaluator,
    /// For each component of the state of the system, where it is found.
    sources: Vec<Source>,
}

/// Where a component of a state is found.
#[derive(Clone, Copy)]
enum Source {
    /// Among those of the linearizer.
    Own(usize),
    /// Among all quasi-velocities.
    Velocity(usize),
}

impl Linear {
    /// The linearizer of a model; `names` are those of the state of the system.
    pub(crate) fn of(model: &Model, names: &[CString], inputs: &[usize]) -> Result<Linear, CallError> {
        model.derived(|assembly| Linear::new(names, model, assembly, inputs))
    }

    /// Whether it was made for these inputs.
    pub(crate) fn has(&self, inputs: &[usize]) -> bool {
        self.inputs == inputs
    }

    fn new(
        state: &[CString],
        model: &Model,
        assembly: &Assembly<'_>,
        inputs: &[usize],
    ) -> Result<Linear, CallError> {
        model.require_values()?;
        let equations = assembly.equations()?;
        let (system, whole) = (equations.system(), assembly.system.quasi_velocities());
        let centre = assembly.system.parameters().iter().copied().chain(assembly.at_start()).collect();
        let integrals = || integrals_of(assembly, &equations, &Neighbourhood { centre }, true);
        let external = system.external_forces().iter().map(|(_, symbol)| symbol.to_string());
        let parameters: Vec<&str> = model.parameters().map(|(name, _)| name).collect();
        let chosen = inputs.iter().map(|&place| parameters[place].to_owned());
        let names: Vec<String> = external.chain(chosen).collect();
        let names: Vec<&str> = names.iter().map(String::as_str).collect();
        let made = LinearModel::of(assembly, &equations, integrals, &names);
        let linearizer = made.map_err(|error| located(assembly, error))?.linearizer;
        // Either all quasi-velocities are in its state, or the independent ones.
        let has_all = linearizer.quasi_velocities().len() == whole.len();
        let all: Vec<Expr<'_>> = match has_all {
            true => Vec::new(),
            false => assembly.quasi_velocities_of(system.quasi_velocities())?,
        };
        let velocities = assembly.placed(equations.functions(&all, &[]))?;
        let known = linearizer.names();
        let place = |name: &str| state.iter().position(|own| own.to_bytes() == name.as_bytes());
        const OTHER: CallError = CallError::Unsupported {
            what: "a linearization in independent components",
            why: "the state has other variables than the model",
        };
        let places = known.iter().map(|name| place(name).ok_or(OTHER)).collect::<Result<_, _>>()?;
        let source = |name: &CString| {
            let is_it = |other: &str| other.as_bytes() == name.to_bytes();
            let own = known.iter().position(|known| is_it(known)).map(Source::Own);
            own.or_else(|| whole.iter().position(|eta| is_it(&eta.to_string())).map(Source::Velocity))
        };
        let sources = state.iter().map(|name| source(name).ok_or(OTHER)).collect::<Result<_, _>>()?;
        Ok(Linear { inputs: inputs.to_vec(), places, velocities, sources, linearizer })
    }

    /// The linear equations about the state y of the system, or a steady motion or equilibrium near it in which the components
    /// `held` have their values; `parameters` are followed by the external forces. They come with the state of the system
    /// that was found.
    pub(crate) fn about(
        &mut self,
        about: About,
        (t, y): (f64, &[f64]),
        held: &[usize],
        parameters: &[f64],
    ) -> Result<(Linearization, Vec<f64>), CallError> {
        self.linearizer.set_parameters(parameters);
        let mut guess: Vec<f64> = self.places.iter().map(|&place| y[place]).collect();
        let of_linearizer = |&place: &usize| self.places.iter().position(|&own| own == place);
        let mut fixed: Vec<String> =
            held.iter().filter_map(of_linearizer).map(|own| self.linearizer.names()[own].clone()).collect();
        if about == About::Rest {
            let moving = self.linearizer.quasi_velocities();
            guess[moving.clone()].fill(0.0);
            fixed.extend(self.linearizer.names()[moving].iter().cloned());
        }
        let options = SteadyOptions::default().fixed(fixed);
        let found = match about {
            About::State => self.linearizer.at(t, &guess),
            // All cyclic coordinates are kept at an equilibrium, none for a steady motion.
            About::Steady | About::Rest => {
                let kept = CyclicCoordinates::KeptAtRest;
                match self.linearizer.steady_with(t, &guess, &options, kept) {
                    Ok(all) if !all.cyclic.is_empty() => self.linearizer.steady(t, &guess, &options),
                    other => other,
                }
            }
        };
        let found = found.map_err(CallError::Analysis)?;
        let state = self.state_of_system(t, &found, parameters)?;
        Ok((found, state))
    }

    /// The state of the system at which the equations were linearised.
    fn state_of_system(
        &mut self,
        t: f64,
        found: &Linearization,
        parameters: &[f64],
    ) -> Result<Vec<f64>, CallError> {
        let own: Vec<f64> = found.state.iter().map(|&(_, value)| value).collect();
        let mut velocities = vec![0.0; self.velocities.program().outputs_len()];
        let parameters = &parameters[..self.velocities.program().parameters_len()];
        if !velocities.is_empty() {
            evaluate(&mut self.velocities, (t, &own, parameters), &mut velocities)?;
        }
        let value = |source: &Source| match *source {
            Source::Own(place) => own[place],
            Source::Velocity(place) => velocities.get(place).copied().unwrap_or(f64::NAN),
        };
        Ok(self.sources.iter().map(value).collect())
    }
}

/// An error of the analysis, at the place in the text that causes it, if there is one.
fn located(assembly: &Assembly<'_>, error: AnalysisError) -> CallError {
    let placed = match error {
        AnalysisError::Nonholo(error) => assembly.placed::<()>(Err(error)),
        AnalysisError::Mech(error) => assembly.placed::<()>(Err(error)),
        AnalysisError::Expr(error) => assembly.placed::<()>(Err(MechError::from(error))),
        other => return CallError::Analysis(other),
    };
    match placed {
        Err(error) => error.into(),
        Ok(()) => CallError::Unsupported { what: "a linearization", why: "it was not derived" },
    }
}
