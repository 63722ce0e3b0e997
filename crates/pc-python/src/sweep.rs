//! Many motions of one model, on all cores.

use std::num::NonZeroUsize;
use std::ops::ControlFlow;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

use numpy::prelude::*;
use numpy::{PyArray1, PyArray2};
use pc_expr::{Cancel, Events};
use pc_model::{Flow, Model, Prototype, Variables};
use pc_solve::{Ending, Ensemble, Options, Solution, Solve, Stop, member_stream};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use rand_distr::{Distribution, LogNormal, Normal, Uniform};

use crate::error::{Error, chain};
use crate::model::renewed;
use crate::plan::Plan;
use crate::system::{SystemCore, derived};
use crate::task::attended;

/// What all members have in common.
struct Members {
    model: Model,
    variables: Variables,
    prototype: Option<Arc<Prototype>>,
    /// Each with whether it is a start value.
    targets: Vec<(String, bool)>,
    /// Of each member one after the other.
    values: Vec<f64>,
    t_start: f64,
    times: Vec<f64>,
    options: Options,
    /// Whether all rows are wanted instead of the last.
    all_rows: bool,
    /// The names of the numbers in a row of each, after its time.
    columns: Vec<String>,
}

/// What is known of a member.
struct Member {
    status: &'static str,
    message: String,
    steps: u64,
    /// Rows with their times in front, filled up where they were not reached.
    rows: Vec<f64>,
}

impl Members {
    fn rows(&self) -> usize {
        if self.all_rows { self.times.len() } else { 1 }
    }

    /// How many numbers a row has, with its time.
    fn width(&self) -> usize {
        1 + self.columns.len()
    }

    fn blank(&self, status: &'static str, message: String) -> Member {
        Member { status, message, steps: 0, rows: vec![f64::NAN; self.rows() * self.width()] }
    }

    fn flow(&self, member: u64) -> Result<Flow, Error> {
        let mut model = self.model.clone();
        let values = self.values.chunks_exact(self.targets.len()).nth(member as usize).unwrap_or_default();
        for ((name, is_start), &value) in self.targets.iter().zip(values) {
            match is_start {
                true => model.set_start(name, value)?,
                false => model.set(name, value)?,
            }
        }
        // Memory is each member's own, time that of all.
        model.within(self.model.budget().beside());
        if let Some(flow) = self.prototype.as_ref().and_then(|known| known.flow(&model, self.t_start)) {
            return Ok(flow);
        }
        derived(&model, self.variables)
    }

    fn integrate(&self, member: u64, stop: &Stop<'_>) -> Member {
        let mut flow = match self.flow(member) {
            Ok(flow) => flow,
            Err(error) => {
                let message = match &error {
                    Error::Model(error) => error.diagnostic().message.clone(),
                    other => chain(other),
                };
                return self.blank("refused", message);
            }
        };
        let own = flow.columns();
        if own != self.columns {
            let message = format!("its table has other columns than that of the system: {}", own.join(", "));
            return self.blank("refused", message);
        }
        let observer = |_: f64, _: &[f64]| match stop.requested() {
            true => ControlFlow::Break(()),
            false => ControlFlow::Continue(()),
        };
        let solve = Solve::new(&mut flow.motion, self.t_start, &flow.start).method(&self.options);
        let (solution, error) = solve.events(&mut flow.events).follow(&self.times, observer);
        let Solution { trajectory, ending, .. } = solution;
        let (status, message) = match (&error, ending) {
            (Some(error), _) => ("failed", chain(error)),
            (None, Some(Ending::Event { event })) => ("event", flow.events.events()[event].name().to_owned()),
            (None, _) => ("completed", String::new()),
        };
        let mut rows = Vec::with_capacity(self.rows() * self.width());
        let mut put = |t: f64, y: &[f64]| {
            rows.push(t);
            rows.extend(flow.row(t, y));
        };
        match self.all_rows {
            true => trajectory.iter().for_each(|(t, y)| put(t, y)),
            false => {
                let reached = error.as_ref().and_then(|error| error.reached()).or_else(|| trajectory.last());
                if let Some((t, y)) = reached {
                    put(t, y);
                }
            }
        }
        rows.truncate(self.rows() * self.width()); // a terminal event has a row of its own
        rows.resize(self.rows() * self.width(), f64::NAN);
        Member { status, message, steps: trajectory.statistics().steps, rows }
    }
}

/// The values of members, each from its own stream: those of `pc sweep` with the same seed.
#[pyfunction]
pub(crate) fn draw<'py>(
    py: Python<'py>,
    laws: Vec<(String, f64, f64)>,
    seed: u64,
    members: usize,
) -> PyResult<Bound<'py, PyArray2<f64>>> {
    let mut values = Vec::with_capacity(laws.len() * members);
    for member in 0..members as u64 {
        let mut stream = member_stream(seed, member);
        for (name, first, second) in &laws {
            let refused = || Error::Law { name: name.clone(), first: *first, second: *second };
            let known = || {
                let known = vec!["normal", "lognormal", "uniform"];
                Error::Choice { what: "the distribution", given: name.clone(), known }
            };
            let value = match name.as_str() {
                "normal" => Normal::new(*first, *second).map(|law| law.sample(&mut stream)).ok(),
                "lognormal" => LogNormal::new(*first, *second).map(|law| law.sample(&mut stream)).ok(),
                "uniform" => Uniform::new_inclusive(*first, *second).map(|law| law.sample(&mut stream)).ok(),
                _ => return Err(known().into()),
            };
            values.push(value.filter(|value: &f64| value.is_finite()).ok_or_else(refused)?);
        }
    }
    PyArray1::from_vec(py, values).reshape([members, laws.len()])
}

#[pymethods]
impl SystemCore {
    /// The motions of members whose `values` stand one after the other; `progress` is told now and then how many are done.
    #[expect(clippy::too_many_arguments, reason = "those of Python")]
    fn ensemble<'py>(
        &self,
        py: Python<'py>,
        targets: Vec<(String, bool)>,
        values: Vec<f64>,
        times: Vec<f64>,
        plan: Plan,
        all_rows: bool,
        threads: Option<NonZeroUsize>,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<Bound<'py, PyDict>> {
        let (mut model, mut flow) = self.now();
        let cancel: Cancel = renewed(&mut model);
        let t_start = self.inventory.t_start;
        let end = times.last().copied().unwrap_or(t_start);
        let options = plan.options((&model, &mut flow), (t_start, end), &cancel)?;
        let members = (values.len() / targets.len().max(1)) as u64;
        let work = Members {
            model,
            variables: self.variables,
            prototype: self.prototype.clone(),
            targets,
            values,
            t_start,
            times,
            options,
            all_rows,
            columns: self.inventory.columns.clone(),
        };
        let (rows, width) = (work.rows(), work.width());
        let done = Arc::new(AtomicU64::new(0));
        let counted = Arc::clone(&done);
        let tick = |py: Python<'_>| match &progress {
            Some(progress) => progress.call1(py, (done.load(Ordering::Relaxed),)).map(drop),
            None => Ok(()),
        };
        let ended = cancel.clone();
        let all = attended(py, &cancel, tick, move || {
            let mut ensemble = Ensemble::new();
            if let Some(threads) = threads {
                ensemble = ensemble.threads(threads);
            }
            let mut all: Vec<Member> = Vec::new();
            let consume = |_: u64, member: Result<Member, pc_solve::Panicked>| {
                all.push(member.unwrap_or_else(|panic| work.blank("panicked", panic.message)));
                counted.fetch_add(1, Ordering::Relaxed);
                if ended.is_cancelled() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
            };
            ensemble.map(0..members, |member, stop| work.integrate(member, stop), consume)?;
            Ok(all)
        })?;
        if let Some(progress) = &progress {
            progress.call1(py, (all.len(),))?;
        }
        let result = PyDict::new(py);
        result.set_item("status", all.iter().map(|member| member.status).collect::<Vec<_>>())?;
        result.set_item("message", all.iter().map(|member| &member.message).collect::<Vec<_>>())?;
        result.set_item("steps", all.iter().map(|member| member.steps).collect::<Vec<_>>())?;
        let values: Vec<f64> = all.iter().flat_map(|member| &member.rows).copied().collect();
        result.set_item("values", PyArray1::from_vec(py, values).reshape([all.len(), rows, width])?)?;
        Ok(result)
    }
}
