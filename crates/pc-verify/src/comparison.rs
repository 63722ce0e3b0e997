//! The comparison of the two derivations.
//!
//! The numbers of the `first` and the `second` derivation are compared as `quantities` with their `natural` sizes, including `solved`
//! unknowns; the result is an `agreement` within the `tolerance`. Large models are compared by `projected` equations.
//! `compare` does so at many states, `outlet` just before results are returned; `printed` compares printed expressions, in
//! all `ways` in which a page states the equations,
//! `slopes` compares derivatives, and `resets` compares states after events. `held_friction` and `unsteady` distinguish jumps and
//! rounding errors from errors of derivation.

pub(crate) mod agreement;
pub(crate) mod compare;
pub(crate) mod first;
mod held_friction;
pub(crate) mod natural;
pub(crate) mod outlet;
pub(crate) mod printed;
pub(crate) mod projected;
pub(crate) mod quantities;
pub(crate) mod resets;
pub(crate) mod second;
pub(crate) mod slopes;
pub(crate) mod solved;
pub(crate) mod tolerance;
pub(crate) mod unsteady;
pub(crate) mod ways;
