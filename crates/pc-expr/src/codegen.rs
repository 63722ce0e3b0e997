//! Programs as source text: the statements of one straight-line function.
//!
//! In goes a [`Program`](crate::Program), out comes text in C or Rust that rounds as the kernels do. Read `codegen` (what
//! is asked for), `function_body` (from a tape to statements), then the words of the languages, `c`, `rust` and
//! `identifier`.

pub(crate) mod c;
pub(crate) mod codegen;
pub(crate) mod function_body;
pub(crate) mod identifier;
pub(crate) mod rust;
