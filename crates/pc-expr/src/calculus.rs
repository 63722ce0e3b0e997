//! Derivatives of expressions, and short forms of the results.
//!
//! `derivative` sweeps backwards for gradients and forwards along a direction; `substitution` puts expressions in place of
//! symbols; `collect` rebuilds an expression as a polynomial whose coefficients no longer contain what they do not depend on,
//! where `numbers` finds the same values; `potential` finds a function by its gradient; `typeset` rewrites expressions
//! to be read.

pub(crate) mod collect;
pub(crate) mod derivative;
pub(crate) mod numbers;
pub(crate) mod potential;
pub(crate) mod substitution;
pub(crate) mod typeset;
