//! The plan of a run, taken from the options, otherwise from the text of the model, otherwise from the
//! defaults.

use pc_model::document::AbsoluteTolerance;
use pc_model::{Flow, Model, UnknownParameter, Variables};
use pc_solve::{Accumulation, Deadline, Method, Options};

use crate::error::RunError;
use crate::plan::Wishes;
use crate::plan::tolerances::Tolerances;

/// The time span, rows, method and tolerances of a run, and the limits on its steps.
#[derive(Clone, Debug, PartialEq)]
pub struct Plan {
    /// Form of the equations.
    pub form: Variables,
    /// Start time.
    pub t_start: f64,
    /// End time, which may lie before the start.
    pub t_end: f64,
    /// Number of rows, at least 2.
    pub samples: usize,
    /// The times of the rows, if they are given.
    pub at: Option<Vec<f64>>,
    /// Relative tolerance.
    pub rtol: f64,
    /// The absolute tolerances, as far as they are given.
    pub atol: AbsoluteTolerance,
    /// The largest length of a step, if it is limited.
    pub max_step: Option<f64>,
    /// The largest number of steps from one row to the next, if given.
    pub max_steps: Option<u64>,
    /// The number of parts of each step that are searched for events, if given.
    pub samples_per_step: Option<u32>,
    /// The fraction of the first interval between events at which they count as accumulated, if given.
    pub accumulation: Option<f64>,
    /// Method.
    pub method: Method,
    /// The numbers of the parameters with respect to which the motion is differentiated.
    pub sensitivities: Vec<usize>,
    /// The deadline of all work on the model.
    pub deadline: Deadline,
}

impl Plan {
    /// The plan for a run of a model.
    ///
    /// # Errors
    /// [`RunError::NoEnd`], [`RunError::EndIsStart`], [`RunError::Sensitivities`],
    /// [`RunError::Tolerance`].
    pub fn of(model: &Model, wishes: &Wishes) -> Result<Plan, RunError> {
        let simulation = &model.document().simulation;
        let t_start = simulation.start_time();
        let no_end = || RunError::NoEnd { model: model.document().source.name().to_owned() };
        let at = wishes.times.clone().filter(|times| !times.is_empty());
        let last = at.as_ref().and_then(|times| times.last().copied());
        let written = simulation.t_end.as_ref().map(|t| t.value);
        let t_end = last.or(wishes.t_end).or(written).ok_or_else(no_end)?;
        if t_end == t_start && at.is_none() {
            return Err(RunError::EndIsStart { t: t_end });
        }
        let rows = at.as_ref().map(Vec::len).or(wishes.samples);
        let written = simulation.method.as_ref().map(|method| method.value);
        Ok(Plan {
            form: Plan::form(model, wishes),
            t_start,
            t_end,
            samples: rows.unwrap_or_else(|| simulation.rows()),
            at,
            rtol: wishes.rtol.unwrap_or_else(|| simulation.relative_tolerance()),
            atol: model.absolute_tolerance(wishes.atol.clone()).map_err(RunError::Tolerance)?,
            max_step: wishes.max_step.or(simulation.max_step.as_ref().map(|h| h.value)),
            max_steps: wishes.max_steps,
            samples_per_step: wishes
                .samples_per_step
                .or(simulation.samples_per_step.as_ref().map(|n| n.value)),
            accumulation: wishes.accumulation.or(simulation.accumulation.as_ref().map(|p| p.value)),
            method: wishes.method.or(written).unwrap_or_default(),
            sensitivities: parameters(model, &wishes.sensitivities)?,
            deadline: model.budget().deadline().clone(),
        })
    }

    /// The form of the equations, which is known before there is a plan.
    pub fn form(model: &Model, wishes: &Wishes) -> Variables {
        let written = model.document().simulation.form.as_ref().map(|form| form.value);
        wishes.form.or(written).unwrap_or(Variables::QuasiVelocities)
    }

    /// The times of the rows: the given ones, otherwise evenly spaced ones, including start and end.
    pub fn times(&self) -> Vec<f64> {
        if let Some(times) = &self.at {
            return times.clone();
        }
        let last = self.samples - 1;
        let span = self.t_end - self.t_start;
        let inner = (0..last).map(|i| self.t_start + span * (i as f64 / last as f64));
        inner.chain([self.t_end]).collect()
    }

    /// The absolute tolerance of each component of the state of a flow.
    pub fn tolerances(&self, flow: &mut Flow) -> Tolerances {
        Tolerances::new(&self.atol, flow, (self.t_start, self.t_end), self.rtol)
    }

    /// The method, the tolerances, and the limits on steps and time, as options of the integrator.
    pub fn options(&self, tolerances: &Tolerances) -> Options {
        let mut options = Options::new(self.method)
            .relative_tolerance(self.rtol)
            .absolute_tolerance(tolerances.tolerance())
            .deadline(self.deadline.clone());
        if let Some(parts) = self.samples_per_step {
            options = options.samples_per_step(parts);
        }
        if let Some(within) = self.accumulation {
            options = options.accumulation(Accumulation { within, ..Accumulation::default() });
        }
        if let Some(most) = self.max_steps {
            options = options.max_steps(most);
        }
        match self.max_step {
            Some(length) => options.max_step(length),
            None => options,
        }
    }

    /// A description of the method, the tolerances and the limit on the length of steps.
    pub fn in_words(&self, tolerances: &Tolerances) -> String {
        let limit = self.max_step.map_or_else(String::new, |length| format!(", steps to {length:e}"));
        format!("{}, rtol {:e}, atol {}{limit}", self.method, self.rtol, tolerances.in_words())
    }
}

/// The numbers of the parameters with these names.
fn parameters(model: &Model, names: &[String]) -> Result<Vec<usize>, RunError> {
    let known: Vec<String> = model.parameters().map(|(name, _)| name.to_owned()).collect();
    let place = |name: &String| {
        let unknown = || UnknownParameter { name: name.clone(), known: known.clone() };
        known.iter().position(|known| known == name).ok_or_else(|| RunError::Sensitivities(unknown()))
    };
    names.iter().map(place).collect()
}
