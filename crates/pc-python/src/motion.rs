//! A motion, integrated.

use std::collections::BTreeMap;
use std::sync::atomic::Ordering;

use numpy::PyArray1;
use numpy::prelude::*;
use pc_expr::VectorField;
use pc_model::{Flow, Model, deep};
use pc_run::motion::derived::Derived;
use pc_run::motion::integrate::Besides;
use pc_run::motion::run::{Ending, Run};
use pc_run::motion::table::Table;
use pc_run::observer::Nobody;
use pc_run::{RunError, chain};
use pc_solve::{Occurrence, SolveError, Statistics};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::error::Error;
use crate::model::{Course, renewed};
use crate::notation::in_python;
use crate::plan::Wished;
use crate::system::{Inventory, SystemCore};
use crate::task::attended;

/// The fraction of its size by which a state may be off the constraints: the first step removes anything
/// smaller.
const OFF: f64 = 1e-6;

/// Checks that a state satisfies the constraints on which steps keep a motion, including those on velocities and the lengths of
/// quaternions.
///
/// # Errors
/// [`Error::OffConstraints`]
pub(crate) fn on_constraints(flow: &mut Flow, t: f64, state: &[f64]) -> Result<(), Error> {
    let size = state.iter().fold(1.0f64, |size, value| size.max(value.abs()));
    if let Some(value) = state.iter().copied().find(|value| !value.is_finite()) {
        return Err(Error::NotFinite { what: "a component of the state".to_owned(), value });
    }
    if !flow.motion.has_projection() {
        return Ok(());
    }
    let mut nearest = state.to_vec();
    flow.motion.project(t, &mut nearest)?;
    let moved = state.iter().zip(&nearest).fold(0.0f64, |moved, (a, b)| moved.max((a - b).abs()));
    if moved > OFF * size { Err(Error::OffConstraints { moved }) } else { Ok(()) }
}

fn statistics<'py>(py: Python<'py>, done: &Statistics) -> PyResult<Bound<'py, PyDict>> {
    let entries = PyDict::new(py);
    entries.set_item("steps", done.steps)?;
    entries.set_item("rhs_evaluations", done.rhs_evaluations)?;
    entries.set_item("jacobian_evaluations", done.jacobian_evaluations)?;
    entries.set_item("error_test_failures", done.error_test_failures)?;
    entries.set_item("nonlinear_iterations", done.nonlinear_iterations)?;
    entries.set_item("nonlinear_failures", done.nonlinear_failures)?;
    entries.set_item("stiff_from", done.stiff_from)?;
    entries.set_item("implicit_steps", done.implicit_steps)?;
    entries.set_item("changes", done.changes)?;
    entries.set_item("last_order", done.last_order)?;
    entries.set_item("last_step", done.last_step)?;
    Ok(entries)
}

/// How the run ended, in one word, and the name of the terminal event if there was one.
fn ending(run: &Run) -> (&'static str, Option<String>) {
    match &run.ending {
        Ending::Completed => ("completed", None),
        Ending::Event { name } => ("event", Some(name.clone())),
        Ending::Failed(_) | Ending::Ended(_) => ("failed", None),
        Ending::Interrupted | Ending::Unwritten => ("stopped", None),
    }
}

/// Why the run did not reach its end, or is wrong.
fn error(run: &Run) -> Option<String> {
    if let Some(lost) = &run.lost {
        return Some(in_python(&RunError::Lost(lost.clone()).to_string()));
    }
    match &run.ending {
        Ending::Failed(error) => Some(in_python(&chain(error.as_ref()))),
        _ => run.stopped().map(|stopped| in_python(&stopped.to_string())),
    }
}

/// The names of the columns, by kind.
fn kinds<'py>(py: Python<'py>, table: &Table) -> PyResult<Bound<'py, PyDict>> {
    let kinds = PyDict::new(py);
    for (kind, places) in [
        ("coordinates", table.coordinates()),
        ("quasi_velocities", table.quasi_velocities()),
        ("states", table.states()),
        ("conserved", table.conserved()),
        ("outputs", table.outputs()),
        ("derivatives", table.derivatives()),
        ("errors", table.errors()),
    ] {
        kinds.set_item(kind, &table.columns()[places])?;
    }
    Ok(kinds)
}

/// `kept` are the values at the start of the quantities that should stay constant.
fn into_dict(py: Python<'_>, run: Run, kept: Vec<f64>) -> PyResult<Bound<'_, PyDict>> {
    let (rows, width) = (run.table.len(), run.table.columns().len() - 1);
    let result = PyDict::new(py);
    let (ending, event) = ending(&run);
    result.set_item("ending", ending)?;
    result.set_item("event", event)?;
    result.set_item("error", error(&run))?;
    result.set_item("t", PyArray1::from_slice(py, run.trajectory.times()))?;
    let states = PyArray1::from_slice(py, run.trajectory.states());
    result.set_item("states", states.reshape([rows, run.trajectory.dim()])?)?;
    let values: Vec<f64> = run.table.rows().flat_map(|row| &row[1..]).copied().collect();
    result.set_item("values", PyArray1::from_vec(py, values).reshape([rows, width])?)?;
    result.set_item("columns", &run.table.columns()[1..])?;
    result.set_item("kinds", kinds(py, &run.table)?)?;
    result.set_item("keeps_energy", run.keeps_energy)?;
    result.set_item("conserved_at_start", kept)?;
    let occurrences = run.occurrences.into_iter().map(|occurrence| {
        let Occurrence { event, time, state_before, state_after } = occurrence;
        let name = run.events.get(event).cloned().unwrap_or_default();
        (name, time, PyArray1::from_vec(py, state_before), PyArray1::from_vec(py, state_after))
    });
    result.set_item("events", occurrences.collect::<Vec<_>>())?;
    result.set_item("residuals", run.constraints.into_iter().collect::<BTreeMap<_, _>>())?;
    result.set_item("statistics", statistics(py, &run.statistics)?)?;
    Ok(result)
}

impl SystemCore {
    /// The model with its present values, and its equations, both with these inputs.
    fn driven(&self, py: Python<'_>, inputs: Vec<(String, Course)>) -> PyResult<(Model, Derived)> {
        let (mut model, derived) = self.now();
        if inputs.is_empty() {
            return Ok((model, derived));
        }
        let tables = |model: &Model| -> Vec<usize> {
            model.parameter_values().tables().iter().map(|&(place, _)| place).collect()
        };
        let (before, mut is_other) = (tables(&model), false);
        for (name, course) in inputs {
            is_other |= matches!(course, Course::Table(..) | Course::Curve(..));
            model.give_input(&name, course.given(&name)?).map_err(Error::from)?;
        }
        is_other |= tables(&model) != before;
        let cancel = renewed(&mut model);
        let (variables, t_start, known) = (self.variables, self.inventory.t_start, model.clone());
        let work = move || {
            deep(|| {
                if !is_other {
                    return Ok(derived.renewed(&known, variables, t_start)?);
                }
                Ok(known.derived(|assembly| Derived::of(&known, assembly, variables))?)
            })
        };
        Ok((model, attended(py, &cancel, |_| Ok(()), work)?))
    }
}

#[pymethods]
impl SystemCore {
    /// The requested motion, and its summary. The first motion of a system is compared with a second derivation, and any other is
    /// not, unless `verify` says otherwise. `inputs` replaces the inputs for this motion alone.
    #[pyo3(name = "_integrate")]
    fn integrate<'py>(
        &self,
        py: Python<'py>,
        wished: Wished,
        start: Option<Vec<f64>>,
        estimate: bool,
        verify: Option<bool>,
        inputs: Vec<(String, Course)>,
    ) -> PyResult<Bound<'py, PyDict>> {
        let (mut model, mut derived) = self.driven(py, inputs)?;
        if let Some(start) = start {
            self.check_length(start.len())?;
            on_constraints(&mut derived.flow, self.inventory.t_start, &start)?;
            derived.flow.start = start;
        }
        let Inventory { t_start, shown, conserved, .. } = &self.inventory;
        let start = derived.flow.start.clone();
        let kept = derived.flow.row(*t_start, &start)[*shown..][..*conserved].to_vec();
        let cancel = renewed(&mut model);
        let plan = wished.plan(&model, self.variables, &cancel)?;
        let verify =
            verify.unwrap_or_else(|| self.inventory.verify && !self.verified.swap(true, Ordering::Relaxed));
        let besides = Besides { verify, estimate, ..Besides::default() };
        let work = move || {
            deep(|| {
                Ok(match wished.differentiates() {
                    true => {
                        model.differentiate_by_parameters(true);
                        Run::planned(&model, plan, &besides, &Nobody)?
                    }
                    false => Run::of_derived(&model, &derived, plan, &besides, &Nobody)?,
                })
            })
        };
        let mut run = attended(py, &cancel, |_| Ok(()), work)?;
        // What is not valid has not begun.
        if let Ending::Failed(error) = &mut run.ending
            && matches!(**error, SolveError::Input(_))
        {
            let begun = std::mem::replace(&mut run.ending, Ending::Interrupted);
            let Ending::Failed(error) = begun else { return into_dict(py, run, kept) };
            return Err(Error::from(*error).into());
        }
        into_dict(py, run, kept)
    }
}
