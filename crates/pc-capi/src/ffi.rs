//! The boundary: what every function does on its way in and out.
//!
//! `boundary` catches panics and writes errors, `status` and `error` are how a call ended, `pointer` turns pointers into
//! references and slices as far as they can be checked, `strings` are text handed to C, `user_data` is what belongs to
//! functions of the program.

pub(crate) mod boundary;
pub(crate) mod error;
pub(crate) mod pointer;
pub(crate) mod status;
pub(crate) mod strings;
pub(crate) mod user_data;
