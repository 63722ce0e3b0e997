//! A motion, integrated.

use std::ops::ControlFlow;

use numpy::PyArray1;
use numpy::prelude::*;
use pc_expr::Events;
use pc_model::{Flow, Model, Variables, deep};
use pc_solve::{
    Ending, ErrorEstimate, Occurrence, Options, Sensitivities, SensitivitySolution, Solution, Solve,
    SolveError, SolveFailure, Statistics, Trajectory, error_of, solve_with_sensitivities_and_events,
};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::error::{Error, chain};
use crate::model::renewed;
use crate::plan::Plan;
use crate::system::{SystemCore, derived};
use crate::task::attended;

/// What came of an integration, as far as it was computed.
pub(crate) struct Outcome {
    trajectory: Trajectory,
    occurrences: Vec<Occurrence>,
    ending: &'static str,
    error: Option<String>,
    /// The name of the terminal event that ended it.
    event: Option<String>,
    columns: Vec<String>,
    /// One row after the other.
    values: Vec<f64>,
    residuals: Vec<(String, f64)>,
}

/// The numbers of parameters.
fn places(model: &Model, names: &[String]) -> Result<Vec<usize>, Error> {
    let known: Vec<String> = model.parameters().map(|(name, _)| name.to_owned()).collect();
    let place = |name: &String| {
        known
            .iter()
            .position(|known| known == name)
            .ok_or_else(|| pc_model::UnknownParameter { name: name.clone(), known: known.clone() }.into())
    };
    names.iter().map(place).collect()
}

/// What is wanted besides the motion.
struct Besides {
    /// Its derivatives by these parameters.
    sensitivities: Vec<String>,
    /// The global errors of its columns.
    errors: bool,
}

/// The motion, with what is wanted besides.
fn integrated(
    mut model: Model,
    mut flow: Flow,
    variables: Variables,
    (t_start, times): (f64, &[f64]),
    options: &Options,
    besides: &Besides,
) -> Result<Outcome, Error> {
    let by = &besides.sensitivities;
    let parameters = places(&model, by)?;
    let mut wanted = Sensitivities::new();
    if !parameters.is_empty() {
        model.differentiate_by_parameters(true);
        flow = derived(&model, variables)?;
        for &j in &parameters {
            wanted = wanted.by_parameter_from(j, Flow::start_by_parameter(&model, variables, j)?);
        }
    }
    let mut beside = besides.errors.then(|| flow.clone());
    let mut matrices: Vec<Vec<f64>> = Vec::new();
    let (motion, start, events) = (&mut flow.motion, &flow.start, &mut flow.events);
    let go_on = |_: f64, _: &[f64]| ControlFlow::Continue(());
    let (solution, error) = match parameters.is_empty() {
        true => Solve::new(motion, t_start, start).method(options).events(events).follow(times, go_on),
        false => {
            let solved = solve_with_sensitivities_and_events(
                motion,
                (t_start, start),
                times,
                options,
                &wanted,
                events,
                go_on,
            );
            let (reached, error) = SolveFailure::split(solved);
            matrices = reached.trajectory.iter().map(|(_, _, matrix)| matrix.to_vec()).collect();
            let trajectory = reached.trajectory.motion().clone();
            let SensitivitySolution { occurrences, ending, slides, .. } = reached;
            (Solution { trajectory, occurrences, ending, slides }, error)
        }
    };
    // What is not valid has not begun.
    let error = match error {
        Some(error @ SolveError::Input(_)) => return Err(error.into()),
        error => error,
    };
    let estimate = beside.as_mut().map(|Flow { motion, start, events, .. }| {
        ErrorEstimate::of(&solution, (motion, t_start, start), events, times, options)
    });
    let Solution { trajectory, occurrences, ending, .. } = solution;
    let observables = flow.motion.observable_names().to_vec();
    let mut columns: Vec<String> = flow.names.iter().chain(&observables).cloned().collect();
    let known = columns.len();
    for name in by {
        columns.extend(flow.names.iter().map(|x| format!("∂{x}/∂{name}")));
    }
    if estimate.is_some() {
        let errors: Vec<String> = columns[..known].iter().map(|name| format!("error({name})")).collect();
        columns.extend(errors);
    }
    let mut values = Vec::with_capacity(columns.len() * trajectory.len());
    let mut residuals: Vec<(String, f64)> =
        flow.constraint_names().into_iter().map(|name| (name, 0.0)).collect();
    for (i, (t, y)) in trajectory.iter().enumerate() {
        let row = flow.row(t, y);
        values.extend_from_slice(&row);
        if let Some(matrix) = matrices.get(i) {
            for (column, &j) in matrix.chunks_exact(y.len()).zip(&parameters) {
                values.extend(flow.derivative(t, y, column, j));
            }
        }
        if let Some(estimate) = &estimate {
            let other = (i < estimate.len())
                .then(|| flow.row(estimate.beside().times()[i], estimate.beside().state(i)));
            let error = |(j, value): (usize, &f64)| {
                other.as_ref().map_or(f64::NAN, |other| error_of(*value, other[j]))
            };
            values.extend(row.iter().enumerate().map(error));
        }
        for ((_, worst), residual) in residuals.iter_mut().zip(flow.constraint_residuals(t, y)) {
            // f64::max would lose a NaN
            if residual.abs() > *worst || residual.is_nan() {
                *worst = residual.abs();
            }
        }
    }
    let event = match ending {
        Some(Ending::Event { event }) => flow.events.events().get(event).map(|event| event.name().to_owned()),
        _ => None,
    };
    let ending = match (&error, ending) {
        (Some(_), _) => "failed",
        (None, Some(Ending::Event { .. })) => "event",
        (None, Some(Ending::Completed)) => "completed",
        (None, _) => "stopped",
    };
    let error = error.map(|error| chain(&error));
    Ok(Outcome { trajectory, occurrences, ending, error, event, columns, values, residuals })
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

impl Outcome {
    fn into_dict<'py>(self, py: Python<'py>, events: &[String]) -> PyResult<Bound<'py, PyDict>> {
        let (rows, width) = (self.trajectory.len(), self.columns.len());
        let result = PyDict::new(py);
        result.set_item("t", PyArray1::from_slice(py, self.trajectory.times()))?;
        let states = PyArray1::from_slice(py, self.trajectory.states());
        result.set_item("states", states.reshape([rows, self.trajectory.dim()])?)?;
        result.set_item("values", PyArray1::from_vec(py, self.values).reshape([rows, width])?)?;
        result.set_item("columns", self.columns)?;
        let occurrences = self.occurrences.into_iter().map(|occurrence| {
            let Occurrence { event, time, state_before, state_after } = occurrence;
            let name = events.get(event).cloned().unwrap_or_default();
            (name, time, PyArray1::from_vec(py, state_before), PyArray1::from_vec(py, state_after))
        });
        result.set_item("events", occurrences.collect::<Vec<_>>())?;
        result.set_item("ending", self.ending)?;
        result.set_item("event", self.event)?;
        result.set_item("error", self.error)?;
        result.set_item(
            "residuals",
            self.residuals.into_iter().collect::<std::collections::BTreeMap<_, _>>(),
        )?;
        result.set_item("statistics", statistics(py, self.trajectory.statistics())?)?;
        Ok(result)
    }
}

#[pymethods]
impl SystemCore {
    /// The motion at these times, and what is said of it.
    fn integrate<'py>(
        &self,
        py: Python<'py>,
        times: Vec<f64>,
        plan: Plan,
        sensitivities: Vec<String>,
        estimate: bool,
    ) -> PyResult<Bound<'py, PyDict>> {
        let (mut model, mut flow) = self.now();
        let events: Vec<String> = flow.events.events().iter().map(|event| event.name().to_owned()).collect();
        let cancel = renewed(&mut model);
        let (variables, t_start) = (self.variables, self.inventory.t_start);
        let end = times.last().copied().unwrap_or(t_start);
        let options = plan.options((&model, &mut flow), (t_start, end), &cancel)?;
        let besides = Besides { sensitivities, errors: estimate };
        let work = move || deep(|| integrated(model, flow, variables, (t_start, &times), &options, &besides));
        attended(py, &cancel, |_| Ok(()), work)?.into_dict(py, &events)
    }
}
