//! Verdicts on identities, including identities that the graph does not decide: proved, open, or disproved.
//!
//! `identity` is the verdict; `sample` evaluates expressions at pseudo-random points near a state, with
//! numbers that distinguish a small value from the rounding error of zero ([`Weighed`](pc_expr::Weighed));
//! `magnitudes` finds the orders of magnitude of symbols in the units of the expressions; `jump` finds points
//! at which an expression jumps, and `discontinuity` finds surfaces on which functions jump, from their
//! values alone.

pub(crate) mod discontinuity;
pub(crate) mod identity;
pub(crate) mod jump;
pub(crate) mod magnitudes;
pub(crate) mod sample;
