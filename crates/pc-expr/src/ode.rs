//! The interface to integrators: ẏ = f(t, y), its derivatives, its events.
//!
//! `vector_field` is the interface between those who derive equations and those who integrate them, `failure` says why a field has no
//! value; `events` are zeros of functions along a motion and resets of the state at these zeros; `forward` is for
//! wrappers of all these; `method` names the methods of integration. `pattern` says where a Jacobian may be nonzero,
//! `colouring` which of its columns can be found from one product, `rate_jump` where the rates jump, `switching` how a
//! piecewise field is held on one of its pieces, `sliding` how it moves along a surface between two pieces, `sliding_range` when it stays there.
//! `program_field` makes a vector field from a program, `lane_field` evaluates one at many states at once, `varied`
//! holds the series of a program together with its derivatives.

pub(crate) mod colouring;
pub(crate) mod events;
pub(crate) mod failure;
mod forward;
pub(crate) mod lane_field;
pub(crate) mod method;
pub(crate) mod pattern;
pub(crate) mod program_field;
pub(crate) mod rate_jump;
pub(crate) mod sliding;
pub(crate) mod sliding_range;
pub(crate) mod switching;
pub(crate) mod varied;
pub(crate) mod vector_field;
