//! Tapes as machine code of x86-64, for vectors of four or eight lanes.
//!
//! `lines` lists the operations that become instructions, `registers` keeps track of the values,
//! `emit` chooses the instructions, which `codes` names and `assembler` encodes, and `code` is the
//! executable result.

mod assembler;
pub(super) mod code;
mod codes;
mod emit;
mod lines;
mod registers;
