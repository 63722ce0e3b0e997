//! DOP853 for many members of an ensemble at once, one in each lane of a vector.
//!
//! A whole step, with its twelve evaluations of f, its error and the length of the next one, is one
//! [tape](pc_expr::LaneTape) and so one piece of machine code. Each lane has a time, a length and a member of its own; where a
//! member has come to its end, the next one begins in its lane.
//!
//! **Same bytes.** A lane does just the operations that it would do alone, each rounded as it is everywhere, and
//! decides by its own numbers alone. So a member's motion does not depend on how many lanes or threads there
//! are, nor on its neighbours. By rounding, and within the tolerances, it differs from that of [`Dop853`](crate::Dop853), which
//! sums without fused multiply-adds and takes errors to the last digit.
//!
//! **Right, or alone.** Lanes give complete motions only. A member that something happens to — f fails, steps are too short or
//! too many — is integrated once more from its start by `Dop853`, alone, whose result or error stands.
//!
//! `plan` says what can be integrated so; `field` evaluates f on a tape, `step`, `start` and `dense` are the tapes of a `problem`, `kernels`
//! what they become for a program, which a `shelf` keeps. An `octet` is eight lanes at work; a `block` lets two of them take turns, and
//! fills their lanes with members that have been `waiting`.

pub(crate) mod block;
mod dense;
mod field;
pub(crate) mod kernels;
pub(crate) mod members;
mod octet;
pub(crate) mod plan;
mod problem;
pub(crate) mod shelf;
mod start;
mod step;
mod waiting;
