//! Programs for many states at once: a number in each of eight lanes.
//!
//! A [`LaneTape`](tape::LaneTape) holds operations on eight numbers at once, a [`LaneKernel`](kernel::LaneKernel) runs it:
//! by an `instruction_set`, on the vectors of the processor, eight or four numbers long, or one operation after the other. `inline` appends
//! programs to a tape, with the `functions` made of operations. Read `tape` first, then `kernel`, `portable` and
//! `machine`.

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
