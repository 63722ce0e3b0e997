//! Steady motions and what can be said of motions near them.

pub(crate) mod definite;
pub(crate) mod second_variation;
pub(crate) mod spectrum;
pub(crate) mod steady;
pub(crate) mod variation;
