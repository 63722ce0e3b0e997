//! A motion, as far as it was computed, with a record of the run.

use std::time::Duration;

use pc_solve::{Occurrence, Slide, SolveError, Spent, Statistics, Trajectory};

use crate::error::RunError;
use crate::motion::accuracy::Accuracy;
use crate::motion::estimate::Estimate;
use crate::motion::lost::LostIntegral;
use crate::motion::table::Table;
use crate::motion::verification::Verification;
use crate::plan::Plan;
use crate::plan::tolerances::Tolerances;

/// A motion, as far as it was computed, with a record of the run.
#[derive(Debug)]
pub struct Run {
    /// The title of the model.
    pub title: String,
    /// The units that its text names, each after its quantity.
    pub units: Vec<(String, String)>,
    /// The parameters with their values.
    pub parameters: Vec<(String, f64)>,
    /// The plan.
    pub plan: Plan,
    /// Names of the components of the state that was integrated.
    pub state: Vec<String>,
    /// The absolute tolerances of these components.
    pub tolerances: Tolerances,
    /// Remarks on components that never exceed their absolute tolerances.
    pub never_exceeded: Vec<String>,
    /// The table, as far as the motion was integrated.
    pub table: Table,
    /// The numbers of its columns that are written, in order.
    pub written: Vec<usize>,
    /// The states of the rows; none if these were written as they were computed.
    pub trajectory: Trajectory,
    /// The motion between its rows too, with as many points as pictures need, if that was requested.
    pub fine: Option<Table>,
    /// A summary of the global errors, if they were requested.
    pub estimate: Option<Estimate>,
    /// What is known of the accuracy of the rows, if that was requested.
    pub accuracy: Option<Accuracy>,
    /// The constraints that are maintained by projection, with the largest residual of each at the output
    /// times.
    pub constraints: Vec<(String, f64)>,
    /// The constraints that were dropped, each with the reason.
    pub dropped: Vec<(String, String)>,
    /// Whether forces are discontinuous functions of the state, as dry friction is.
    pub jumps: bool,
    /// Whether the motion conserves its energy: nothing depends on time and the forces do no work.
    pub keeps_energy: bool,
    /// The names of the events that the model has.
    pub events: Vec<String>,
    /// The numbers of the events whose functions are zero at the start and then move in the direction of the
    /// event, which does not count as an occurrence.
    pub passed_at_start: Vec<usize>,
    /// The occurrences of events, in order.
    pub occurrences: Vec<Occurrence>,
    /// The parts of the motion that slide along a surface on which forces jump.
    pub slides: Vec<Slide>,
    /// How the motion ended.
    pub ending: Ending,
    /// An integral that is proved to be conserved but has changed: the motion is wrong.
    pub lost: Option<LostIntegral>,
    /// If the motion failed, the velocity that has lost its inertia and the fraction of the inertia that is left.
    pub lost_inertia: Option<(String, f64)>,
    /// The result of the comparison with a second derivation, if there was one.
    pub verification: Option<Verification>,
    /// The result of the comparison in the run that has kept the equations, if they come from there.
    pub verified_before: Vec<String>,
    /// The work that the integration took.
    pub statistics: Statistics,
    /// The computing time.
    pub wall: Duration,
}

/// How a run ended.
#[derive(Debug)]
pub enum Ending {
    /// The run reached its end time.
    Completed,
    /// A terminal event ended the run.
    Event {
        /// Its name.
        name: String,
    },
    /// Ctrl-C ended the run.
    Interrupted,
    /// The time limit ended the run.
    Ended(Spent),
    /// A row could not be written.
    Unwritten,
    /// The integration could not continue.
    Failed(Box<SolveError>),
}

impl Ending {
    /// The word for this ending in output.
    pub fn word(&self) -> &'static str {
        match self {
            Ending::Completed => "completed",
            Ending::Event { .. } => "event",
            Ending::Interrupted => "interrupted",
            Ending::Ended(_) => "ended by its limit",
            Ending::Unwritten => "not written",
            Ending::Failed(_) => "failed",
        }
    }
}

impl Run {
    /// The time that the run reached.
    pub fn reached(&self) -> f64 {
        match (&self.ending, self.occurrences.last()) {
            (Ending::Event { .. }, Some(occurrence)) => occurrence.time,
            (Ending::Completed, _) => self.plan.t_end,
            _ => self.statistics.current_time,
        }
    }

    /// Whether the observer ended the run, as Ctrl-C does: there is a part of the motion.
    pub fn is_interrupted(&self) -> bool {
        matches!(self.ending, Ending::Interrupted)
    }

    /// The error for a run that was ended by the observer or by a time limit.
    pub fn stopped(&self) -> Option<RunError> {
        let t = self.statistics.current_time;
        match self.ending {
            Ending::Interrupted => Some(RunError::Interrupted { t }),
            Ending::Ended(limit) => Some(RunError::Ended { t, limit }),
            Ending::Completed | Ending::Event { .. } | Ending::Unwritten | Ending::Failed(_) => None,
        }
    }

    /// An error unless the run was completed and conserved every integral that is proved to be conserved.
    ///
    /// # Errors
    /// [`RunError::Lost`], [`RunError::Interrupted`], [`RunError::Ended`],
    /// [`RunError::Integration`].
    pub fn outcome(self) -> Result<(), RunError> {
        let stopped = self.stopped();
        if let Some(lost) = self.lost {
            return Err(RunError::Lost(lost));
        }
        if let Some(stopped) = stopped {
            return Err(stopped);
        }
        match self.ending {
            Ending::Failed(cause) => Err(RunError::Integration {
                cause,
                names: self.state,
                jumps: self.jumps,
                lost_inertia: self.lost_inertia,
            }),
            // The error of the file says why it is unwritten.
            _ => Ok(()),
        }
    }
}
