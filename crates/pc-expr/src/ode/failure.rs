//! The reason why a function has no value at a state.

use std::error::Error;
use std::fmt;

/// Why a function of (t, y) could not be evaluated, and whether a nearby state may succeed.
///
/// The message of a failure is that of its cause.
#[derive(Debug)]
pub struct Failure {
    recoverable: bool,
    cause: Box<dyn Error + Send + Sync>,
}

impl fmt::Display for Failure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.cause.fmt(f)
    }
}

impl Error for Failure {
    fn source(&self) -> Option<&(dyn Error + 'static)> {
        self.cause.source()
    }
}

impl Failure {
    /// A failure that a smaller step may avoid, such as a state outside the domain of a function.
    pub fn recoverable(cause: impl Error + Send + Sync + 'static) -> Self {
        Failure { recoverable: true, cause: Box::new(cause) }
    }

    /// A failure that ends the integration.
    pub fn fatal(cause: impl Error + Send + Sync + 'static) -> Self {
        Failure { recoverable: false, cause: Box::new(cause) }
    }

    /// Whether a smaller step may avoid the failure.
    pub fn is_recoverable(&self) -> bool {
        self.recoverable
    }

    /// What went wrong.
    pub fn cause(&self) -> &(dyn Error + Send + Sync + 'static) {
        self.cause.as_ref()
    }
}
