//! Whether an integration gets on.
//!
//! Steps may become so short, without any of them failing, that a motion would take years. This
//! shows long before the limit of steps does: [`STEPS`] steps that advance by less than [`LEAST`] of
//! what is left would have to be followed by 10¹³ of their kind.

use pc_expr::{Events, VectorField};

use crate::error::{Reason, Shrinks, SolveError};
use crate::integration::integration::Integration;
use crate::integration::stepper::Stepper;

/// The number of steps that are looked at together.
const STEPS: u64 = 10_000;
/// The least part of the remaining time that they advance.
const LEAST: f64 = 1e-9;

/// The steps since a mark.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Pace {
    steps: u64,
    mark: f64,
    limited: u64,
}

impl<S: Stepper, E: Events> Integration<S, E> {
    /// Notes a step towards `end`.
    ///
    /// # Errors
    /// [`Reason::Crawls`] if the last ones have hardly advanced.
    pub(crate) fn note_pace(&mut self, end: f64) -> Result<(), SolveError> {
        let t = self.front.t;
        self.pace.steps += 1;
        if self.pace.steps < STEPS {
            return Ok(());
        }
        let limited = self.statistics().limited_steps;
        let now = Pace { steps: 0, mark: t, limited };
        let Pace { steps, mark, limited: before } = std::mem::replace(&mut self.pace, now);
        let (by, rest) = ((t - mark).abs(), (end - mark).abs());
        // The first mark is no time that has been reached.
        let is_known = std::mem::replace(&mut self.is_paced, true);
        if !is_known || by >= LEAST * rest {
            return Ok(());
        }
        let shortened = 2 * limited.saturating_sub(before) >= steps;
        let cause = if shortened { Shrinks::Time } else { Shrinks::Component(self.fastest()) };
        Err(self.failed(Reason::Crawls { steps, by, cause }, None))
    }

    /// The component whose rate is the largest by the tolerances.
    fn fastest(&mut self) -> String {
        let (t, state) = (self.front.t, self.front_state.clone());
        let mut rates = vec![f64::NAN; state.len()];
        // Rates that fail are as fast as any.
        let known = self.engine.field_mut().rhs(t, &state, &mut rates).is_ok();
        let speed = |i: usize| if known { rates[i].abs() / self.engine.tolerance(i, state[i]) } else { 0.0 };
        let fastest = (0..state.len()).max_by(|&i, &j| speed(i).total_cmp(&speed(j))).unwrap_or(0);
        self.field().component_name(fastest)
    }
}
