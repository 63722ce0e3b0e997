//! Many motions at once, over all cores.
//!
//! Read `ensemble`; `ordered` puts results of threads in the order of the members, `random` gives each member its own
//! stream of random numbers, `stop` ends them early.

pub(crate) mod ensemble;
pub(crate) mod in_lanes;
pub(crate) mod ordered;
pub(crate) mod random;
pub(crate) mod stop;
