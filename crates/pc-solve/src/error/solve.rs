//! Why an integration was not begun or not completed.

use std::error::Error;
use std::fmt;

use pc_expr::{Failure, Spent};

use crate::error::input::InputError;
use crate::error::reason::Reason;
use crate::error::return_code::Code;

/// Why an integration was not begun or not completed.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum SolveError {
    /// The problem or an option is invalid; no step was made.
    #[error(transparent)]
    Input(#[from] InputError),

    /// SUNDIALS could not create or set up one of its objects; with valid input, this means that
    /// memory ran out.
    #[error("{function} failed with code {code}: {message}")]
    Setup {
        /// The function of SUNDIALS that failed.
        function: &'static str,
        /// The return code of the function.
        code: i32,
        /// The message from SUNDIALS.
        message: String,
    },

    /// The integration began and could not go on.
    #[error(transparent)]
    Integration(Box<IntegrationError>),
}

impl SolveError {
    /// Which limit ended the integration, if any did.
    pub fn ended(&self) -> Option<Spent> {
        match self {
            SolveError::Integration(error) => error.reason.ended(),
            SolveError::Input(_) | SolveError::Setup { .. } => None,
        }
    }

    /// The return code of CVODES that corresponds to the reason, if there is one.
    pub fn code(&self) -> Option<Code> {
        match self {
            SolveError::Integration(error) => error.reason.code(),
            SolveError::Input(_) | SolveError::Setup { .. } => None,
        }
    }

    /// The last time and state reached, (t, y), if the integration had begun.
    pub fn reached(&self) -> Option<(f64, &[f64])> {
        match self {
            SolveError::Integration(error) => Some((error.time, &error.state)),
            SolveError::Input(_) | SolveError::Setup { .. } => None,
        }
    }
}

/// Why an integration could not go on, and the last state it reached.
///
/// The [`source`](Error::source) of this error is the cause of
/// [`failure`](IntegrationError::failure).
#[derive(Debug)]
#[non_exhaustive]
pub struct IntegrationError {
    /// Why the integration could not go on.
    pub reason: Reason,
    /// The end of the last successful internal step.
    pub time: f64,
    /// The state at [`time`](IntegrationError::time), one number per component of the field.
    pub state: Vec<f64>,
    /// The last failure of the vector field there: one that the field itself reported, or
    /// [`NonFinite`](crate::NonFinite) for a number that is not finite.
    pub failure: Option<Failure>,
}

impl fmt::Display for IntegrationError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.reason.write(self.time, f)
    }
}

impl Error for IntegrationError {
    fn source(&self) -> Option<&(dyn Error + 'static)> {
        self.failure.as_ref().map(|failure| failure.cause() as &(dyn Error + 'static))
    }
}
