//! A motion whose rows are written while it is integrated, so that they take no memory.

use std::ops::ControlFlow;

use pc_model::Flow;
use pc_solve::{Solution, Solve, SolveError, SolveFailure};

use crate::error::CliError;
use crate::motion::interrupt;
use crate::motion::plan::Plan;
use crate::motion::table::Table;
use crate::output::stream::Stream;

/// What is known of the rows that were written.
pub(crate) struct Given<'s, 'p> {
    /// What they are read off: the one that is integrated is in use.
    flow: Flow,
    stream: &'s mut Stream<'p>,
    /// The last of them, and how far they drifted.
    pub(crate) table: Table,
    /// The largest residual of each constraint.
    pub(crate) constraints: Vec<(String, f64)>,
    /// The last output.
    pub(crate) last: Option<(f64, Vec<f64>)>,
}

impl<'s, 'p> Given<'s, 'p> {
    /// # Errors
    /// [`CliError::Write`]
    pub(crate) fn new(flow: &Flow, stream: &'s mut Stream<'p>) -> Result<Given<'s, 'p>, CliError> {
        let table = Table::given(flow);
        stream.begin(table.columns())?;
        let constraints = flow.constraint_names().into_iter().map(|name| (name, 0.0)).collect();
        Ok(Given { flow: flow.clone(), stream, table, constraints, last: None })
    }

    /// The motion as far as it can be computed, and why not further; without its states.
    pub(crate) fn follow(
        &mut self,
        flow: &mut Flow,
        plan: &Plan,
        step: impl FnMut(f64, &[f64]) -> ControlFlow<()>,
    ) -> (Solution, Option<SolveError>) {
        let options = plan.options();
        let solve =
            Solve::new(&mut flow.motion, plan.t_start, &flow.start).method(&options).events(&mut flow.events);
        SolveFailure::split(solve.run_given(&plan.times(), |t, y| self.take(t, y), step))
    }

    /// Whether a row could not be written.
    pub(crate) fn has_failed(&self) -> bool {
        self.stream.has_failed()
    }

    fn take(&mut self, t: f64, y: &[f64]) -> ControlFlow<()> {
        // There may be many rows in a step.
        if interrupt::requested() {
            return ControlFlow::Break(());
        }
        self.table.give(&mut self.flow, t, y);
        note_residuals(&mut self.constraints, &mut self.flow, t, y);
        self.last = Some((t, y.to_vec()));
        match self.table.rows().next_back() {
            Some(row) => self.stream.row(row),
            None => ControlFlow::Continue(()),
        }
    }
}

/// Raises the largest residuals to those at (t, y).
pub(crate) fn note_residuals(worst: &mut [(String, f64)], flow: &mut Flow, t: f64, y: &[f64]) {
    for ((_, worst), residual) in worst.iter_mut().zip(flow.constraint_residuals(t, y)) {
        // f64::max would lose a NaN
        if residual.abs() > *worst || residual.is_nan() {
            *worst = residual.abs();
        }
    }
}
