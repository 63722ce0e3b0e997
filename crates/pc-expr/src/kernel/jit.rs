//! The compiling kernel: a program as machine code of the host, made by Cranelift at run time.
//!
//! A program becomes machine code in three steps, one file each: `plan` decides what is computed when and what waits
//! in memory, `emit` writes that down as Cranelift's intermediate code with `sincos` writing sines and cosines in
//! line, and `assembly` owns the code that results. `host` knows the processor; `jit` is the kernel.

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
