//! `pc run --estimate`: the global errors of the columns of a motion, estimated by a companion motion.

use std::ops::{ControlFlow, Range};

use pc_model::Flow;
use pc_solve::{Ending, ErrorEstimate, Events, Method, Options, Solution, error_of};

use crate::motion::table::Table;
use crate::observer::Observer;
use crate::plan::Plan;
use crate::plan::tolerances::Tolerances;
use pc_print::short;

/// An error counts as having grown to the size of the motion if it exceeds this fraction of the largest values.
const GROWN: f64 = 0.1;
/// An error that has grown to the size of the motion also exceeds this many absolute tolerances.
const TOLERANCES: f64 = 10.0;

/// A summary of the global errors of a motion; the table contains these errors row by row.
#[derive(Clone, Debug, PartialEq)]
pub struct Estimate {
    /// The integration method of the companion.
    pub method: Method,
    /// The relative tolerance of the companion.
    pub rtol: f64,
    /// The number of rows whose errors are known.
    pub rows: usize,
    /// The time at which the error has grown to the size of the motion.
    pub grown: Option<f64>,
    /// The times of the rows before which an event occurred in only one of the two motions.
    pub beyond_events: Vec<f64>,
    /// The reason why later rows have no errors, if there is one.
    pub incomplete: Option<String>,
}

/// Integrates the companion of a motion; the flow must be as it was before the motion.
pub(crate) fn companion(
    flow: &mut Flow,
    (plan, options): (&Plan, &Options),
    motion: &Solution,
    observer: &dyn Observer,
) -> ErrorEstimate {
    let mut progress = observer.motion((plan.t_start, plan.t_end));
    let step = |t: f64, _: &[f64]| {
        progress(t);
        if observer.is_stopped() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    };
    let start = (&mut flow.motion, plan.t_start, flow.start.as_slice());
    ErrorEstimate::observed(motion, start, &mut flow.events, &plan.times(), options, step)
}

impl Estimate {
    /// Appends the errors of all columns, except t and derivatives, to the table and returns their summary;
    /// they are NaN where they are not known.
    pub(crate) fn of(
        estimate: &ErrorEstimate,
        flow: &mut Flow,
        (motion, tolerances): (&Solution, &Tolerances),
        table: &mut Table,
    ) -> Estimate {
        let columns = 1..table.derivatives().start;
        let names = table.columns()[columns.clone()].iter().map(|name| column_of_errors(name)).collect();
        let beside: Vec<(f64, &[f64])> = estimate.beside().iter().take(estimate.len()).collect();
        let row = |i: usize, row: &[f64]| -> Vec<f64> {
            match beside.get(i) {
                Some((t, y)) => {
                    let others = flow.row(*t, y);
                    row[columns.clone()].iter().zip(others).map(|(v, other)| error_of(*v, other)).collect()
                }
                None => vec![f64::NAN; columns.len()],
            }
        };
        table.append_errors(names, row);
        let companion = estimate.companion();
        let beyond_events = estimate.beyond_events(motion);
        let times: Vec<f64> = table.column(0).collect();
        Estimate {
            method: companion.method(),
            rtol: companion.relative_tolerance(),
            rows: estimate.len(),
            grown: grown(table, TOLERANCES * tolerances.largest(), &beyond_events),
            beyond_events: beyond_events.into_iter().map(|i| times[i]).collect(),
            incomplete: (estimate.len() < table.len()).then(|| why(estimate, flow)),
        }
    }
}

/// The name of the column with the errors of a column.
pub(crate) fn column_of_errors(name: &str) -> String {
    format!("error({name})")
}

/// Why a companion did not reach the end of the motion.
pub(crate) fn why(estimate: &ErrorEstimate, flow: &Flow) -> String {
    let t = short(estimate.beside().statistics().current_time, 10);
    match (estimate.failure(), estimate.ending()) {
        (Some(error), _) if error.ended().is_some() => {
            format!("the limit of time ended the companion at {t}")
        }
        (Some(error), _) => format!("the companion failed at {t}: {error}"),
        (None, Some(Ending::Event { event })) => {
            let (name, t) = (flow.events.events()[event].name(), estimate.beside().times().last());
            format!("the event {name} ended the companion at {}", short(t.copied().unwrap_or(f64::NAN), 10))
        }
        (None, Some(Ending::Completed)) => format!("no event ended the companion up to {t}"),
        (None, Some(Ending::Stopped) | None) => format!("the companion was interrupted at {t}"),
    }
}

/// The time of the first row, other than the rows `others`, in which the norm of the errors of the coordinates, of the
/// velocities or of the first-order states exceeds both a tenth of the norm of their largest values and `negligible`.
fn grown(table: &Table, negligible: f64, others: &[usize]) -> Option<f64> {
    let kinds = [table.coordinates(), table.quasi_velocities(), table.states()];
    let norm = |values: &mut dyn Iterator<Item = f64>| values.map(|v| v * v).sum::<f64>().sqrt();
    let bounds = kinds.clone().map(|kind| {
        let largest = norm(&mut kind.map(|j| table.largest(j)));
        (GROWN * largest).max(negligible)
    });
    let is_grown = |&(i, row): &(usize, &[f64])| {
        let errors =
            |kind: &Range<usize>| norm(&mut kind.clone().filter_map(|j| Some(row[table.error_of(j)?])));
        !others.contains(&i) && kinds.iter().zip(&bounds).any(|(kind, bound)| errors(kind) > *bound)
    };
    table.rows().enumerate().find(is_grown).map(|(_, row)| row[0])
}
