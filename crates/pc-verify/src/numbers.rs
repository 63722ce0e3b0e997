//! Numbers with what has to be known of them.
//!
//! A `number` carries its rates of change, a `sized` value the size of its terms, which a `balance` sums and `linear` equations are
//! solved with; `rounding` puts in errors on purpose, `units` are the sizes that the text has chosen.

pub(crate) mod balance;
pub(crate) mod linear;
pub(crate) mod number;
pub(crate) mod rounding;
pub(crate) mod sized;
pub(crate) mod units;
