//! The boundary: what every function does at its beginning and end.
//!
//! Pointers come in from C, and are turned into references or into an error. Read `status` first,
//! which says how a call ended, then `call_error`, the ways in which it can fail; `strings` is text
//! handed to C; `pointer` turns pointers into references and slices as far as they can be checked,
//! `error` is what C receives from a failed call, and `boundary` catches panics and writes errors.
//! `user_data` holds the arguments of the program's functions.
//!
//! A function that only looks at a handle takes it as `Option<&T>`: C passes null or a live
//! handle, and `None` is null. The other arguments remain pointers, because a reference promises
//! more than C does. Memory for results may be uninitialised, and a function of the program that
//! the call runs may write to the same memory for an error, so these pointers are not `&mut T`;
//! arrays are checked for length, alignment and overlap before they become slices; a handle that is
//! changed may be in use by another thread, which `Exclusive` answers with PC_BUSY, and a handle
//! that is freed ceases to exist while the call still runs.

pub(crate) mod boundary;
pub(crate) mod call_error;
pub(crate) mod error;
pub(crate) mod pointer;
pub(crate) mod status;
pub(crate) mod strings;
pub(crate) mod user_data;
