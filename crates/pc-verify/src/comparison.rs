//! Both derivations, compared.
//!
//! The `first` and the `second` as numbers become `quantities` with their `natural` sizes, `solved` unknowns among them, and an `agreement` within the
//! `tolerance`; of large models `projected` ones. `compare` is that at many states, `outlet` that of what leaves a model, `printed` that of
//! printed expressions, `slopes` of derivatives, `resets` of states after events. `unsteady` tells jumps and rounding from errors.

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
