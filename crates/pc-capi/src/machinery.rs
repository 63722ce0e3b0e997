//! What stands behind the handles.
//!
//! Read `exclusive` first, what one call may use at a time; `controller`, the functions of the program that compute
//! forces, and `motion_field`, what is integrated with them or without; `lock_free_rhs`, f(t, y) by nothing but machine
//! code, and `mechanics`, the parts of the equations; `system` is all these behind a handle. An `engine` is an integration
//! with what is remembered of it, `event_set` the events it follows. `draft` is a model put together call by call.

pub(crate) mod controller;
pub(crate) mod draft;
pub(crate) mod engine;
pub(crate) mod event_set;
pub(crate) mod exclusive;
pub(crate) mod lock_free_rhs;
pub(crate) mod mechanics;
pub(crate) mod motion_field;
pub(crate) mod system;
