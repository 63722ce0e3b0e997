//! The settings of an integration.

use std::collections::BTreeMap;

use pc_expr::{Cancel, Deadline, Limits};
use pc_model::document::AbsoluteTolerance;
use pc_model::{Flow, Model};
use pc_solve::{Accumulation, Method, Options, Tolerance};
use pyo3::prelude::*;

use crate::error::Error;

/// Method, tolerances and limits, as a mapping of Python has them.
#[derive(Clone, FromPyObject)]
#[pyo3(from_item_all)]
pub(crate) struct Plan {
    method: String,
    rtol: f64,
    atol: Option<Absolute>,
    max_step: Option<f64>,
    samples_per_step: Option<u32>,
    accumulation: Option<f64>,
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

impl Plan {
    /// The options of an integration of the flow of a model over a span of time, which `cancel` ends.
    ///
    /// # Errors
    /// [`Error::Choice`] for an unknown method, [`Error::Start`] for a tolerance of what is no component of the state.
    pub(crate) fn options(
        &self,
        (model, flow): (&Model, &mut Flow),
        span: (f64, f64),
        cancel: &Cancel,
    ) -> Result<Options, Error> {
        let given = self.atol.as_ref().map_or_else(AbsoluteTolerance::default, Absolute::given);
        let given = model.absolute_tolerance(given)?;
        let absolute = Tolerance::each(flow.absolute_tolerances(&given, span, self.rtol));
        let method = Method::named(&self.method).ok_or_else(|| Error::Choice {
            what: "the method",
            given: self.method.clone(),
            known: Method::ALL.map(Method::name).to_vec(),
        })?;
        let time = self.limit_time.and_then(|seconds| std::time::Duration::try_from_secs_f64(seconds).ok());
        let limits = Limits { cancel: cancel.clone(), time, ..Limits::default() };
        let mut options = Options::new(method)
            .relative_tolerance(self.rtol)
            .absolute_tolerance(absolute)
            .deadline(Deadline::new(&limits));
        if let Some(parts) = self.samples_per_step {
            options = options.samples_per_step(parts);
        }
        if let Some(within) = self.accumulation {
            options = options.accumulation(Accumulation { within, ..Accumulation::default() });
        }
        if let Some(length) = self.max_step {
            options = options.max_step(length);
        }
        Ok(options)
    }
}
