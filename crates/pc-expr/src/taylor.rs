//! Taylor coefficients of solutions of ẏ = f(t, y), f a program [Moore 1966; Jorba, Zou 2005].
//!
//! Each operation of f has a recurrence for the coefficient of order k of its result by those of its operands.
//! `recurrences`, with those of the `functions`, writes all of them down as two programs, one for order 0 and one for every order
//! above, which the usual kernels run; what they leave out, sums over the orders between, is the same for every operation: `sums`.
//! `assembler` writes programs; `coefficients` runs them order by order. `separation` finds times between which functions along a
//! polynomial motion have at most one root.

mod assembler;
pub(crate) mod coefficients;
mod functions;
mod recurrences;
pub(crate) mod separation;
pub(crate) mod sums;
