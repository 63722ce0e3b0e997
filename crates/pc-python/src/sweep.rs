//! Many motions of one model, on all cores.

use std::num::NonZeroUsize;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};

use numpy::prelude::*;
use numpy::{PyArray1, PyArray2};
use pc_model::deep;
use pc_run::observer::{Observer, Progress};
use pc_run::sweep::Sweep;
use pc_run::sweep::design::Design;
use pc_run::sweep::law::{Law, LawError};
use pc_run::sweep::record::Record;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::error::Error;
use crate::model::renewed;
use crate::plan::Wished;
use crate::system::SystemCore;
use crate::task::attended;

/// The observer through which Python waits for a sweep.
#[derive(Default)]
struct Waiting {
    stop: AtomicBool,
    done: AtomicU64,
}

impl Observer for Waiting {
    fn stop(&self) -> &AtomicBool {
        &self.stop
    }

    fn members(&self, _before: u64, _members: u64) -> Progress<'_, u64> {
        Box::new(|done| self.done.store(done, Ordering::Relaxed))
    }
}

/// The values drawn for members, each from its own stream: the same as those of `pc sweep` with the same seed.
#[pyfunction]
pub(crate) fn draw<'py>(
    py: Python<'py>,
    laws: Vec<(String, f64, f64)>,
    seed: u64,
    members: u64,
) -> PyResult<Bound<'py, PyArray2<f64>>> {
    let law = |(name, first, second): &(String, f64, f64)| match Law::of(name, *first, *second) {
        Ok(law) if first.is_finite() && second.is_finite() => Ok(law),
        Err(LawError::Unknown { .. }) => {
            Err(Error::Choice { what: "the distribution", given: name.clone(), known: Law::NAMES.to_vec() })
        }
        _ => Err(Error::Law { name: name.clone(), first: *first, second: *second }),
    };
    let laws = laws.iter().map(law).collect::<Result<Vec<_>, Error>>()?;
    let values: Vec<f64> = (0..members).flat_map(|member| Law::draw(&laws, seed, member)).collect();
    PyArray1::from_vec(py, values).reshape([members as usize, laws.len()])
}

/// All rows of a member, as many as every other member has: a terminal event has a row of its own, and rows that were not reached are
/// NaN.
fn rows_of(record: &Record, rows: usize, width: usize) -> Vec<f64> {
    let mut numbers = record.rows.clone(); // the drifts behind a single row are cut off
    numbers.truncate(rows * width);
    numbers.resize(rows * width, f64::NAN);
    numbers
}

#[pymethods]
impl SystemCore {
    /// The motions of members, whose `values` of the quantities are given one member after the other; from time to time `progress` is
    /// told how many are done. If the sweep is to be verified, the first member, one in the middle and the last are compared with a
    /// second derivation.
    #[expect(clippy::too_many_arguments, reason = "those of Python")]
    #[pyo3(name = "_ensemble")]
    fn ensemble<'py>(
        &self,
        py: Python<'py>,
        names: Vec<String>,
        values: Vec<f64>,
        wished: Wished,
        all_rows: bool,
        threads: Option<NonZeroUsize>,
        verify: Option<bool>,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<Bound<'py, PyDict>> {
        let (mut model, derived) = self.now();
        let cancel = renewed(&mut model);
        let plan = wished.plan(&model, self.variables, &cancel)?;
        let rows = if all_rows { plan.samples } else { 1 };
        let width = 1 + self.inventory.columns.len();
        let verify = verify.unwrap_or(self.inventory.verify);
        let names: Vec<&str> = names.iter().map(String::as_str).collect();
        let design = Design::listed(&model, &names, values).map_err(Error::from)?;
        let waiting = Arc::new(Waiting::default());
        let work = {
            let waiting = Arc::clone(&waiting);
            move || {
                deep(|| {
                    let sweep = Sweep::of_motions(model, design, (plan, all_rows), &derived, threads)?;
                    if verify {
                        sweep.vouched()?;
                    }
                    Ok(sweep.collect(&*waiting)?)
                })
            }
        };
        let tick = |py: Python<'_>| match &progress {
            Some(progress) => progress.call1(py, (waiting.done.load(Ordering::Relaxed),)).map(drop),
            None => Ok(()),
        };
        let all = attended(py, &cancel, tick, work).inspect_err(|_| {
            waiting.stop.store(true, Ordering::Relaxed);
        })?;
        if let Some(progress) = &progress {
            progress.call1(py, (all.len(),))?;
        }
        let result = PyDict::new(py);
        result.set_item("status", all.iter().map(|member| member.status.word()).collect::<Vec<_>>())?;
        result.set_item("message", all.iter().map(|member| &member.message).collect::<Vec<_>>())?;
        result.set_item("steps", all.iter().map(|member| member.steps).collect::<Vec<_>>())?;
        let values: Vec<f64> = all.iter().flat_map(|member| rows_of(member, rows, width)).collect();
        result.set_item("values", PyArray1::from_vec(py, values).reshape([all.len(), rows, width])?)?;
        Ok(result)
    }
}
