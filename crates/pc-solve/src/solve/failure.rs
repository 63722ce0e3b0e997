//! Failures of an integration, with the part of the motion that was reached before the failure.

use std::error::Error;
use std::fmt;

use crate::error::SolveError;
use crate::integration::trajectory::Trajectory;

/// A failed integration, for example one by [`solve`](crate::solve()), with the part of the motion
/// that it had reached.
#[derive(Debug)]
#[non_exhaustive]
pub struct SolveFailure<R = Trajectory> {
    /// The outputs before the failure.
    pub reached: R,
    /// What went wrong.
    pub error: SolveError,
}

impl<R> SolveFailure<R> {
    /// What was reached, and the error if the integration failed.
    pub fn split(outcome: Result<R, Box<SolveFailure<R>>>) -> (R, Option<SolveError>) {
        match outcome {
            Ok(reached) => (reached, None),
            Err(failure) => (failure.reached, Some(failure.error)),
        }
    }

    pub(crate) fn map<T>(self, part: impl FnOnce(R) -> T) -> SolveFailure<T> {
        SolveFailure { reached: part(self.reached), error: self.error }
    }
}

impl<R> fmt::Display for SolveFailure<R> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.error.fmt(f)
    }
}

impl<R: fmt::Debug> Error for SolveFailure<R> {
    fn source(&self) -> Option<&(dyn Error + 'static)> {
        self.error.source()
    }
}
