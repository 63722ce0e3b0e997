//! Equations of motion as C or Rust source that depends on nothing of this library.
//!
//! In go equations, out come [files](emit::EmittedFile): `emit` decides what is computed, `c` and `rust` write it down.

pub(crate) mod c;
pub(crate) mod emit;
pub(crate) mod rust;
