//! The compiling kernel: a program as machine code of the host, compiled by Cranelift at run time.
//!
//! A program becomes machine code in three steps, one file each: `plan` decides the order of
//! computation and which values are kept in memory, `emit` writes Cranelift's intermediate code,
//! with sines and cosines inline by `sincos`, and `assembly` owns the resulting code. `host`
//! describes the processor; `jit` is the kernel.

#![expect(
    unsafe_code,
    reason = "compiled code is entered through a function pointer, and its memory is freed by hand"
)]

mod assembly;
mod emit;
mod error;
mod host;
mod jit;
mod memory;
mod options;
mod plan;
mod prologue;
mod shim;
mod sincos;
pub(crate) mod sums;

pub use error::JitError;
pub use jit::Jit;
pub use options::JitOptions;
