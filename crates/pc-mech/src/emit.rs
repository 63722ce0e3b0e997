//! Equations of motion as C or Rust source without dependencies.
//!
//! Equations are written to [files](source::EmittedFile). Read `source` (the contents of a file), `function`
//! (further functions), then `c` and `rust`, which write these contents, then `emit`, which decides what is
//! computed.

pub(crate) mod c;
pub(crate) mod emit;
pub(crate) mod function;
pub(crate) mod rust;
pub(crate) mod source;
