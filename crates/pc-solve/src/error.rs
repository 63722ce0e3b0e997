//! Errors of integration.
//!
//! `input`: with a problem or an option, before the first step. `solve`: in an integration, for a `reason`, which may be a
//! `return_code` of CVODES or that a number is `non_finite`.

pub(crate) mod input;
pub(crate) mod non_finite;
pub(crate) mod reason;
pub(crate) mod return_code;
pub(crate) mod solve;

pub use input::InputError;
pub use non_finite::NonFinite;
pub use reason::Reason;
pub use return_code::Code;
pub use solve::{IntegrationError, SolveError};
