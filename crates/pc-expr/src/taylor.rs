//! Taylor coefficients of solutions of ẏ = f(t, y), where f is a program [Moore 1966; Jorba, Zou 2005].
//!
//! Each operation of f has a recurrence that gives the coefficient of order k of its result from those of its
//! operands. `recurrences`, with those of the `functions`, writes these recurrences down as two programs, one
//! for order 0 and one for every order above, which the usual kernels run; the sums over intermediate orders
//! have the same form for every operation: `sums`. `assembler` writes programs; `coefficients` runs them
//! order by order. `separation` finds times between which functions along a polynomial motion have at most
//! one root.

pub(crate) mod assembler;
pub(crate) mod coefficients;
mod functions;
mod recurrences;
pub(crate) mod separation;
pub(crate) mod sums;
