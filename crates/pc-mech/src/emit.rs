//! Equations of motion as C or Rust source that depends on nothing of this library.
//!
//! Equations become [files](source::EmittedFile). Read `source` (the contents of a file), `function` (what may be added to it), `c` and `rust`, which write
//! it, then `emit`, which decides what is computed.

pub(crate) mod c;
pub(crate) mod emit;
pub(crate) mod function;
pub(crate) mod rust;
pub(crate) mod source;
