//! Kernels, which run programs: an interpreter, and machine code.
//!
//! A [`Program`](crate::Program) gives the same numbers in every [`Kernel`](kernel::Kernel). Read
//! `kernel` (the interface, and the interpreter, which works everywhere) with `tape`, `jit`
//! (machine code by Cranelift), then `evaluator`, a program with a kernel made on first use;
//! `lanes` runs programs for many states at once. `circle` holds the coefficients of sine and
//! cosine.

pub(crate) mod circle;
pub(crate) mod evaluator;
#[cfg(feature = "jit")]
pub(crate) mod jit;
pub(crate) mod kernel;
pub(crate) mod lanes;
pub(crate) mod tape;
