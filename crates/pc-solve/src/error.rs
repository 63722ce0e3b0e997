//! Errors of integration.
//!
//! `input` has the errors in a problem or an option, which are found before the first step; `solve`
//! has the errors of an integration, with their `reason` and possibly a `return_code` of CVODES;
//! `non_finite` has the errors about a number that is NaN or infinite.

pub(crate) mod input;
pub(crate) mod non_finite;
pub(crate) mod reason;
pub(crate) mod return_code;
pub(crate) mod solve;

pub use input::InputError;
pub use non_finite::NonFinite;
pub use reason::{Reason, Shrinks};
pub use return_code::Code;
pub use solve::{IntegrationError, SolveError};
