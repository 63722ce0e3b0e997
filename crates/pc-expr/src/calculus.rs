//! Derivatives of expressions, and short forms of the results.
//!
//! `derivative` sweeps backwards for gradients and forwards along a direction; `substitution` puts
//! expressions in place of symbols. `collect` rebuilds an expression as a polynomial from the `powers` of each symbol
//! in it; `independence` removes symbols that cancel from the coefficients, with the help of `numbers` and, if
//! constants are rounded, `rounding`; `polynomial` writes the result out. `potential` finds a function from its
//! gradient; `root_powers` makes powers of roots recognisable; `typeset` rewrites expressions for readers and measures
//! them in `columns`; `multiplied_out` expands brackets if sines and cosines then merge; `breaks` and `seams` find
//! the surfaces on which expressions may jump, and `held` keeps expressions on one side of these surfaces;
//! `commensurable` finds terms of the same dimension, and `common_denominator` the divisors.

pub(crate) mod breaks;
pub(crate) mod collect;
mod columns;
mod commensurable;
mod common_denominator;
pub(crate) mod derivative;
pub(crate) mod held;
pub(crate) mod independence;
pub(crate) mod multiplied_out;
pub(crate) mod numbers;
pub(crate) mod polynomial;
pub(crate) mod potential;
pub(crate) mod powers;
pub(crate) mod root_powers;
mod rounding;
pub(crate) mod seams;
pub(crate) mod substitution;
pub(crate) mod typeset;
