//! The boundary: what every function does on its way in and out.
//!
//! In go pointers from C, out come references, or an error. Read `status` first, how a call ended, then `call_error`, the
//! ways in which it can fail, with their `strings` as text handed to C; `pointer` turns pointers into references and slices
//! as far as they can be checked, `error` is what C gets of a failed call, and `boundary` catches panics and writes errors.
//! `user_data` is what belongs to functions of the program.

pub(crate) mod boundary;
pub(crate) mod call_error;
pub(crate) mod error;
pub(crate) mod pointer;
pub(crate) mod status;
pub(crate) mod strings;
pub(crate) mod user_data;
