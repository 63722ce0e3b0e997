//! Checkpoints, from which a motion resumes with the same numbers to the last bit.
//!
//! A multistep method depends on its history. So a motion with checkpoints restarts at each of
//! them, whether it is interrupted or not: everything after a checkpoint depends only on its
//! contents. This changes the motion within its tolerance, and costs the steps in which the order
//! grows again.
//! ```
//! use pc_solve::{Checkpoint, Integration, Options, from_fn};
//!
//! let field = || from_fn(2, |_t, y, ydot| { ydot[0] = y[1]; ydot[1] = -y[0].sin(); Ok(()) });
//! let options = Options::default();
//! let mut motion = Integration::new(field(), 0.0, &[1.0, 0.0], &options)?;
//! motion.state_at(2.0)?;
//! let bytes = motion.checkpoint().to_bytes("pendulum");
//!
//! let mut motion = Integration::resume(motion.into_field(), &Checkpoint::from_bytes(&bytes)?.0, &options)?;
//! let mut later = Integration::resume(field(), &Checkpoint::from_bytes(&bytes)?.0, &options)?;
//! assert_eq!(motion.state_at(4.0)?, later.state_at(4.0)?);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//! With events, a checkpoint also holds their status: on which side of zero each function is, when
//! each event last occurred, and which events are due. A quantity that a field conserves by
//! projection, such as the energy, keeps the value that the field was given at its creation or,
//! after a [restart](crate::Integration::restart), for example by a reset, the value at the state
//! of the checkpoint.

use std::num::NonZeroU64;

use crate::events::events::{History, Occurrence};
use crate::integration::statistics::Statistics;
use crate::integration::trajectory::Trajectory;

/// The time and state of a motion, the outputs and occurrences up to then, and the work so far.
///
/// The state is y, projected if the field has a projection: it includes the offset d in y = z + d,
/// which is zero again after the restart.
#[derive(Debug, Clone, PartialEq)]
pub struct Checkpoint {
    pub(crate) time: f64,
    pub(crate) state: Vec<f64>,
    pub(crate) outputs: Trajectory,
    pub(crate) occurrences: Vec<Occurrence>,
    pub(crate) statistics: Statistics,
    /// The number of steps since the last output; a limit applies to this number.
    pub(crate) steps_since_output: u64,
    /// Whether the motion has been restarted, for example by a reset: if so, quantities that the
    /// field conserves by projection keep the values they have at this state.
    pub(crate) jumped: bool,
    /// S, column-major; empty without sensitivities.
    pub(crate) sensitivities: Vec<f64>,
    /// S at the outputs, one matrix after the other.
    pub(crate) output_sensitivities: Vec<f64>,
    /// The status of the events, once a motion has begun.
    pub(crate) past: Option<Past>,
}

/// The status of events.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Past {
    /// The status of each event.
    pub(crate) events: Vec<EventPast>,
    /// The events at the time of the checkpoint that are still to be applied, each with the
    /// magnitude above which its function then counts as nonzero, and the side of zero on which the
    /// function will be next.
    pub(crate) due: Vec<(usize, f64, f64)>,
}

/// The status of one event.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct EventPast {
    /// The side of zero on which the function of the event is: 1, −1, or 0 while it is at zero.
    pub(crate) side: f64,
    /// The magnitude that the function must exceed to have left zero.
    pub(crate) noise: f64,
    /// The last occurrences of the event.
    pub(crate) history: History,
}

impl Checkpoint {
    /// The default number of steps from one checkpoint to the next: many more than the few dozen
    /// short steps that follow a restart.
    pub const EVERY: NonZeroU64 = NonZeroU64::new(1000).expect("not 0");

    /// The checkpoint at the start of a motion.
    pub fn start(t0: f64, y0: &[f64]) -> Checkpoint {
        Checkpoint {
            time: t0,
            state: y0.to_vec(),
            outputs: Trajectory::new(y0.len()),
            occurrences: Vec::new(),
            statistics: Statistics::default(),
            steps_since_output: 0,
            jumped: false,
            sensitivities: Vec::new(),
            output_sensitivities: Vec::new(),
            past: None,
        }
    }

    /// The time of the checkpoint.
    pub fn time(&self) -> f64 {
        self.time
    }

    /// The state at the checkpoint.
    pub fn state(&self) -> &[f64] {
        &self.state
    }

    /// The sensitivities at the checkpoint, column-major; empty if there are none.
    pub fn sensitivities(&self) -> &[f64] {
        &self.sensitivities
    }

    /// The outputs of [`solve_checkpointed`](crate::Resumable) up to the time of the
    /// checkpoint.
    pub fn outputs(&self) -> &Trajectory {
        &self.outputs
    }

    /// The occurrences of events in [`solve_checkpointed`](crate::Resumable) up to the
    /// time of the checkpoint.
    pub fn occurrences(&self) -> &[Occurrence] {
        &self.occurrences
    }

    /// The work up to the time of the checkpoint.
    pub fn statistics(&self) -> &Statistics {
        &self.statistics
    }
}
