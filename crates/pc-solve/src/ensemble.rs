//! The integration of many motions at once, on all cores.
//!
//! Read `ensemble` first; `in_lanes` integrates members together in vector lanes, `ordered` puts
//! the results of the threads in the order of the members, `random` gives each member its own
//! stream of random numbers, `stop` ends an ensemble early.

pub(crate) mod ensemble;
pub(crate) mod in_lanes;
pub(crate) mod ordered;
pub(crate) mod random;
pub(crate) mod stop;
