//! What stands behind the handles.
//!
//! `draft` is a model put together call by call, `field` what is integrated, `engine` an integration with what is
//! remembered of it, `event_set` the events it follows, `exclusive` what one call may use at a time, `lock_free_rhs`
//! f(t, y) by nothing but machine code.

pub(crate) mod draft;
pub(crate) mod engine;
pub(crate) mod event_set;
pub(crate) mod exclusive;
pub(crate) mod field;
pub(crate) mod lock_free_rhs;
