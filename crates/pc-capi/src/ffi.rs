//! The boundary: what every function does at its beginning and end.
//!
//! Pointers come in from C, and leave as references or as an error. Read `status` first, how a
//! call ended, then `call_error`, the ways in which it can fail, with their `strings` as text
//! handed to C; `pointer` turns pointers into references and slices as far as they can be
//! checked, `error` is what C receives from a failed call, and `boundary` catches panics and
//! writes errors. `user_data` holds the arguments of the program's functions.
//!
//! A function that only looks at a handle takes it as `Option<&T>`: C passes null or a live
//! handle, and `None` is null. The others keep pointers, because a reference promises more
//! than C does. Places for results may hold nothing yet, and a function of the program that
//! the call runs may write to the same place for an error, so they are not `&mut T`; arrays are
//! checked for length, alignment and overlap before they become slices; a handle that is
//! changed may be in use by another thread, which `Exclusive` answers with PC_BUSY, and one
//! that is freed ends while the call still runs.

pub(crate) mod boundary;
pub(crate) mod call_error;
pub(crate) mod error;
pub(crate) mod pointer;
pub(crate) mod status;
pub(crate) mod strings;
pub(crate) mod user_data;
