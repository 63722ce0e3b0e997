//! Tapes as machine code of x86-64, for vectors of four or eight lanes.
//!
//! `lines` says what becomes instructions, `registers` which value is where, `emit` chooses the instructions, which
//! `codes` names and `assembler` writes, and `code` is the result, which runs.

mod assembler;
pub(super) mod code;
mod codes;
mod emit;
mod lines;
mod registers;
