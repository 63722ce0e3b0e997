//! The result of a comparison.

use std::fmt;

use crate::comparison::projected::DIRECTIONS;
use crate::error::{Disagreement, Irregular, VerifyError};

/// The agreement of two derivations, and how close it is.
#[derive(Clone, Debug, PartialEq)]
pub struct Agreement {
    /// The number of states at which the forms were compared.
    pub states: usize,
    /// The number of these states at which equations were compared only along random virtual velocities,
    /// because the model is large.
    pub projected: usize,
    /// The number of states that were skipped because the equations are singular or not defined there.
    pub skipped: usize,
    /// The reason why the last of the skipped states had to be skipped.
    pub reason: Option<String>,
    /// The largest difference, relative to the size of the terms; at most [`TOLERANCE`](crate::TOLERANCE).
    pub error: f64,
    /// The quantity with the largest difference.
    pub quantity: String,
    /// The forms that were compared: `poincare`, `canonical`, `emit`.
    pub forms: Vec<String>,
    /// The quantities that were not compared, each with the reason.
    pub not_compared: Vec<String>,
}

impl fmt::Display for Agreement {
    /// Writes, for example, `agrees to 3e-15 at 97 states, 3 not comparable: the equations for the
    /// accelerations are singular`
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let plural = if self.states == 1 { "" } else { "s" };
        if self.error == 0.0 {
            write!(f, "agrees to the last digit at {} state{plural}", self.states)?;
        } else {
            write!(f, "agrees to {:.0e} at {} state{plural}", self.error, self.states)?;
        }
        match self.projected {
            0 => {}
            all if all == self.states => write!(f, " along {DIRECTIONS} random virtual velocities")?,
            some => write!(f, ", at {some} of them along {DIRECTIONS} random virtual velocities")?,
        }
        match (self.skipped, &self.reason) {
            (0, _) => Ok(()),
            (skipped, reason) => {
                write!(f, ", {skipped} not comparable: {}", reason.as_deref().unwrap_or("not regular"))
            }
        }
    }
}

impl Agreement {
    /// Records a difference, relative to the size of its terms.
    pub(crate) fn note(&mut self, error: f64, label: &str) {
        if error > self.error || self.quantity.is_empty() {
            (self.error, self.quantity) = (error, label.to_owned());
        }
    }

    pub(crate) fn leave_out(&mut self, what: &str, reason: &str) {
        let line = format!("{what}: {reason}");
        if !self.not_compared.contains(&line) {
            self.not_compared.push(line);
        }
    }

    pub(crate) fn pass_over(&mut self, passed: Passed) -> Result<(), VerifyError> {
        match passed {
            Passed::Error(error) => Err(error),
            Passed::Noise(disagreement) => Err(VerifyError::Disagreement(disagreement)),
            Passed::Irregular(irregular) => {
                self.skipped += 1;
                self.reason = Some(irregular.to_string());
                Ok(())
            }
        }
    }
}

/// The reason why the comparison at a state gives no agreement.
pub(crate) enum Passed {
    /// The state is not regular.
    Irregular(Irregular),
    /// The derivations differ.
    Error(VerifyError),
    /// The derivations differ, but by no more than the rounding errors of the first at this state explain.
    Noise(Box<Disagreement>),
}

impl From<Irregular> for Passed {
    fn from(irregular: Irregular) -> Passed {
        match irregular {
            Irregular::Unable(unable) => Passed::Error(unable.into()),
            irregular => Passed::Irregular(irregular),
        }
    }
}
