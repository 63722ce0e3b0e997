//! Programs as source text: the statements of one straight-line function.
//!
//! A [`Program`](crate::Program) is written as C or Rust source that rounds as the kernels do. Read `layout` (the
//! request and the result), the words of the languages (`comment`, `c`, `rust` and `identifier`, which `language`
//! offers), then `function_body` (from a tape to statements) and `codegen`, its entry point; `chain` writes long
//! tapes as tables.

pub(crate) mod c;
pub(crate) mod chain;
pub(crate) mod codegen;
pub(crate) mod comment;
pub(crate) mod function_body;
pub(crate) mod identifier;
pub(crate) mod language;
pub(crate) mod layout;
pub(crate) mod rust;
