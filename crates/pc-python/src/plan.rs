//! The options of a run, from Python.

use std::collections::BTreeMap;
use std::time::Duration;

use pc_expr::{Cancel, Deadline, Limits};
use pc_model::document::AbsoluteTolerance;
use pc_model::{Flow, Model, Variables};
use pc_run::Plan;
use pc_run::Wishes;
use pc_solve::{Method, Options};
use pyo3::prelude::*;

use crate::error::Error;

/// The options in a Python mapping; `None` stands for the value in the text, or else the default.
#[derive(Clone, FromPyObject)]
#[pyo3(from_item_all)]
pub(crate) struct Wished {
    t_end: Option<f64>,
    samples: Option<usize>,
    times: Option<Vec<f64>>,
    method: Option<String>,
    rtol: Option<f64>,
    atol: Option<Absolute>,
    max_step: Option<f64>,
    samples_per_step: Option<u32>,
    accumulation: Option<f64>,
    sensitivities: Vec<String>,
    limit_time: Option<f64>,
}

/// Absolute tolerances: a number, or a mapping of names.
#[derive(Clone, FromPyObject)]
enum Absolute {
    All(f64),
    Each(BTreeMap<String, f64>),
}

impl Absolute {
    fn given(&self) -> AbsoluteTolerance {
        match self {
            Absolute::All(all) => AbsoluteTolerance { all: Some(*all), each: Vec::new() },
            Absolute::Each(each) => {
                let each = each.iter().map(|(name, &tolerance)| (name.clone(), tolerance));
                AbsoluteTolerance { all: None, each: each.collect() }
            }
        }
    }
}

impl Wished {
    /// The plan for running a model in a given form; `cancel` ends the run.
    ///
    /// # Errors
    /// [`Error::Choice`] for an unknown method, and those of [`Plan::of`].
    pub(crate) fn plan(&self, model: &Model, form: Variables, cancel: &Cancel) -> Result<Plan, Error> {
        let method = self.method.as_deref().map(|given| {
            Method::named(given).ok_or_else(|| Error::Choice {
                what: "the method",
                given: given.to_owned(),
                known: Method::ALL.map(Method::name).to_vec(),
            })
        });
        let wishes = Wishes {
            form: Some(form),
            t_end: self.t_end,
            samples: self.samples,
            times: self.times.clone(),
            rtol: self.rtol,
            atol: self.atol.as_ref().map_or_else(AbsoluteTolerance::default, Absolute::given),
            max_step: self.max_step,
            max_steps: None,
            samples_per_step: self.samples_per_step,
            accumulation: self.accumulation,
            method: method.transpose()?,
            sensitivities: self.sensitivities.clone(),
        };
        let time = limit(self.limit_time)?;
        let limits = Limits { cancel: cancel.clone(), time, ..Limits::default() };
        Ok(Plan { deadline: Deadline::new(&limits), ..Plan::of(model, &wishes)? })
    }

    /// Whether there are derivatives with respect to parameters.
    pub(crate) fn differentiates(&self) -> bool {
        !self.sensitivities.is_empty()
    }
}

/// The time limit of this many seconds; none for `None` and for infinity.
///
/// # Errors
/// [`Error::LimitTime`] for a negative number, or one that is too large.
pub(crate) fn limit(seconds: Option<f64>) -> Result<Option<Duration>, Error> {
    match seconds {
        None | Some(f64::INFINITY) => Ok(None),
        Some(seconds) => match Duration::try_from_secs_f64(seconds) {
            Ok(time) => Ok(Some(time)),
            Err(_) => Err(Error::LimitTime { seconds }),
        },
    }
}

/// The options of an integration according to a plan.
pub(crate) fn options(plan: &Plan, flow: &mut Flow) -> Options {
    plan.options(&plan.tolerances(flow))
}
