//! The objects behind the handles.
//!
//! Read `exclusive` first, which guards values that one call at a time may use; then `controller`,
//! the functions of the program that compute forces, and `motion_field`, the vector field that is
//! integrated, with or without them; `lock_free_rhs`, f(t, y) computed by machine code alone for
//! any number of threads, `own_rhs`, the same for one thread, `mechanics`, the parts of the
//! equations, `kinematics`, the Jacobians of bodies, `slopes`, the derivatives by state, parameters and forces, and `linear`, the linear equations in independent components; `system`
//! puts all these behind a handle. `engine` is an integration with a record of its events, `watch` what it reports, `event_set` the events it follows. `draft` is a model built call by call.

pub(crate) mod code;
pub(crate) mod controller;
pub(crate) mod derivations;
pub(crate) mod draft;
pub(crate) mod engine;
pub(crate) mod event_set;
pub(crate) mod exclusive;
pub(crate) mod kinematics;
pub(crate) mod linear;
pub(crate) mod lock_free_rhs;
pub(crate) mod mechanics;
pub(crate) mod motion_field;
pub(crate) mod once;
pub(crate) mod own_rhs;
pub(crate) mod slopes;
pub(crate) mod system;
pub(crate) mod watch;
