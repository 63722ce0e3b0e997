//! Numbers with additional information.
//!
//! A `number` carries its rates of change and a `sized` value the size of its terms; a `balance` sums such terms, and `linear`
//! equations use their sizes; `rounding` introduces deliberate errors, and `units` are the sizes implied by the text.

pub(crate) mod balance;
pub(crate) mod linear;
pub(crate) mod number;
pub(crate) mod rounding;
pub(crate) mod sized;
pub(crate) mod units;
