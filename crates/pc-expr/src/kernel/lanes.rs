//! Programs for many states at once, one in each of eight lanes.
//!
//! A [`LaneTape`](tape::LaneTape) holds operations on eight numbers at once, a
//! [`LaneKernel`](kernel::LaneKernel) runs it, either with an `instruction_set` that has vectors of eight or
//! four numbers or without machine code. `inline` appends programs to a tape, with `functions` built from its
//! operations. Read `tape` first, then `kernel`, `portable` and `machine`.

#![cfg_attr(
    all(feature = "jit", target_arch = "x86_64", unix),
    expect(unsafe_code, reason = "machine code is entered through a pointer, and calls functions back")
)]

mod functions;
mod inline;
pub(crate) mod instruction_set;
pub(crate) mod kernel;
#[cfg(all(feature = "jit", target_arch = "x86_64", unix))]
mod machine;
mod portable;
pub(crate) mod tape;
