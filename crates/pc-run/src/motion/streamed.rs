//! A motion whose rows are written as they are computed, so that they take no memory.

use std::ops::ControlFlow;

use pc_model::Flow;
use pc_solve::{Options, Solution, Solve, SolveError, SolveFailure};

use crate::files::error::FileError;
use crate::files::stream::Stream;
use crate::motion::table::{Table, raised};
use crate::observer::Observer;
use crate::plan::Plan;
use crate::plan::tolerances::note_largest;

/// A record of the rows that were written.
pub(crate) struct Streamed<'s, 'p> {
    /// A second flow, with which rows are computed, since the integration uses the first.
    flow: Flow,
    stream: &'s mut Stream<'p>,
    /// The numbers of the columns that are written.
    written: &'s [usize],
    observer: &'s dyn Observer,
    /// The last row, and the drifts so far.
    pub(crate) table: Table,
    /// The largest residual of each constraint.
    pub(crate) constraints: Vec<(String, f64)>,
    /// The largest magnitude of each component of the state.
    pub(crate) largest: Vec<f64>,
    /// The last output.
    pub(crate) last: Option<(f64, Vec<f64>)>,
}

impl<'s, 'p> Streamed<'s, 'p> {
    /// # Errors
    /// [`FileError::Write`]
    pub(crate) fn new(
        flow: &Flow,
        (stream, written): (&'s mut Stream<'p>, &'s [usize]),
        observer: &'s dyn Observer,
    ) -> Result<Streamed<'s, 'p>, FileError> {
        let table = Table::streamed(flow);
        stream.begin(written.iter().map(|&j| &table.columns()[j]))?;
        let constraints = flow.constraint_names().into_iter().map(|name| (name, 0.0)).collect();
        Ok(Streamed {
            flow: flow.clone(),
            stream,
            written,
            observer,
            table,
            constraints,
            largest: Vec::new(),
            last: None,
        })
    }

    /// Integrates the motion as far as possible, without keeping its states; the error says why it ended.
    pub(crate) fn follow(
        &mut self,
        flow: &mut Flow,
        (plan, options): (&Plan, &Options),
        step: impl FnMut(f64, &[f64]) -> ControlFlow<()>,
    ) -> (Solution, Option<SolveError>) {
        let solve =
            Solve::new(&mut flow.motion, plan.t_start, &flow.start).method(options).events(&mut flow.events);
        SolveFailure::split(solve.run_given(&plan.times(), |t, y| self.take(t, y), step))
    }

    /// Whether a row could not be written.
    pub(crate) fn has_failed(&self) -> bool {
        self.stream.has_failed()
    }

    fn take(&mut self, t: f64, y: &[f64]) -> ControlFlow<()> {
        // A step may have many rows, so steps alone do not notice Ctrl-C in time.
        if self.observer.is_stopped() {
            return ControlFlow::Break(());
        }
        self.table.give(&mut self.flow, t, y);
        note_residuals(&mut self.constraints, &mut self.flow, t, y);
        note_largest(&mut self.largest, y);
        self.last = Some((t, y.to_vec()));
        match self.table.rows().next_back() {
            Some(row) => self.stream.row(self.written.iter().map(|&j| row[j])),
            None => ControlFlow::Continue(()),
        }
    }
}

/// Raises the largest residuals to those at (t, y), where these are larger.
pub(crate) fn note_residuals(worst: &mut [(String, f64)], flow: &mut Flow, t: f64, y: &[f64]) {
    for ((_, worst), residual) in worst.iter_mut().zip(flow.constraint_residuals(t, y)) {
        *worst = raised(*worst, residual);
    }
}
