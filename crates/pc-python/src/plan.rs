//! The settings of an integration.

use pc_expr::{Cancel, Deadline, Limits};
use pc_solve::{Accumulation, Method, Options};
use pyo3::prelude::*;

use crate::error::Error;

/// Method, tolerances and limits, as a mapping of Python has them.
#[derive(Clone, FromPyObject)]
#[pyo3(from_item_all)]
pub(crate) struct Plan {
    method: String,
    rtol: f64,
    atol: f64,
    max_step: Option<f64>,
    samples_per_step: Option<u32>,
    accumulation: Option<f64>,
    limit_time: Option<f64>,
}

impl Plan {
    /// The options of an integration that `cancel` ends.
    ///
    /// # Errors
    /// [`Error::Choice`] for an unknown method.
    pub(crate) fn options(&self, cancel: &Cancel) -> Result<Options, Error> {
        let method = match self.method.as_str() {
            "adams" => Method::Adams,
            "bdf" => Method::Bdf,
            "dop853" => Method::Dop853,
            "taylor" => Method::Taylor,
            "auto" => Method::Auto,
            other => {
                let known = vec!["adams", "bdf", "dop853", "taylor", "auto"];
                return Err(Error::Choice { what: "the method", given: other.to_owned(), known });
            }
        };
        let time = self.limit_time.and_then(|seconds| std::time::Duration::try_from_secs_f64(seconds).ok());
        let limits = Limits { cancel: cancel.clone(), time, ..Limits::default() };
        let mut options = Options::new(method)
            .relative_tolerance(self.rtol)
            .absolute_tolerance(self.atol)
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
