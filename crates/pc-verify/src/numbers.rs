//! Numbers with additional information.
//!
//! A `number` carries its rates of change, a `sized` value the size of its terms, which a `balance` sums and `linear` equations
//! use; `rounding` introduces deliberate errors, `units` are the sizes implied by the text.

pub(crate) mod balance;
pub(crate) mod linear;
pub(crate) mod number;
pub(crate) mod rounding;
pub(crate) mod sized;
pub(crate) mod units;
