//! Both derivations, compared.
//!
//! The numbers of the `first` and the `second` become `quantities` with their `natural` sizes, including `solved` unknowns, and an `agreement` within
//! the `tolerance`; large models have `projected` quantities. `compare` compares them at many states, `outlet` before results are returned, `printed`
//! for printed expressions, `slopes` for derivatives, `resets` for states after events. `unsteady` distinguishes jumps and rounding from errors.

pub(crate) mod agreement;
pub(crate) mod compare;
pub(crate) mod first;
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
