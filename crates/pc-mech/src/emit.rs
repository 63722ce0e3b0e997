//! Equations of motion as C or Rust source that depends on nothing of this library.
//!
//! In go equations, out come [files](source::EmittedFile). Read `source` (what is written), `c` and `rust`, which write it,
//! then `emit`, which decides what is computed.

pub(crate) mod c;
pub(crate) mod emit;
pub(crate) mod rust;
pub(crate) mod source;
