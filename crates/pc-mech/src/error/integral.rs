//! Errors of integrals that are to be kept constant.

use crate::error::lists::{listed, quoted};

/// An error of integrals.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum IntegralError {
    /// An integral that is to be kept but does not exist in the system.
    #[error("`{name}` is not an integral of the system; there are {}", quoted(known))]
    Unknown {
        /// The requested name.
        name: String,
        /// The integrals of the system.
        known: Vec<String>,
    },
    /// A function to be kept that is not an integral.
    #[error("`{name}` cannot be kept: it changes along the motion, at t = {t} at the rate {rate}")]
    NotAnIntegral {
        /// The integral.
        name: String,
        /// The time at which it was found to change.
        t: f64,
        /// The rate of change of the function.
        rate: f64,
    },
    /// A function to be kept that may jump, and so is constant only between jumps.
    #[error("`{name}` cannot be kept: it may jump along the motion, to another value than that at the start")]
    Jumps {
        /// The integral.
        name: String,
    },
    /// Newton's method found no state with the values of the [kept](crate::Motion::keep) integrals.
    #[error("no state with the values of the integrals was found near t = {t}{}", listed(state))]
    NotKept {
        /// Time.
        t: f64,
        /// Names and values of the state.
        state: Vec<(String, f64)>,
    },
}
