//! DOP853 for many members of an ensemble at once, one in each lane of a vector.
//!
//! A whole step, with its twelve evaluations of f, its error and the length of the next step, is
//! one [tape](pc_expr::LaneTape) and therefore one piece of machine code. Each lane has its own
//! time, step length and member; when a member is finished, the next one begins in its lane.
//!
//! **Reproducible.** A lane performs the same operations, with the same rounding, as it would
//! alone, and its decisions depend on its own values only. So a member's motion depends neither on
//! the number of lanes or threads nor on its neighbours. It differs from that of
//! [`Dop853`](crate::Dop853) within the tolerances: the latter sums without fused multiply-adds and
//! computes errors to full precision.
//!
//! **Fallback.** Lanes give complete motions only. A member for which f fails, or whose steps
//! become too short or too many, is integrated again by itself from its start, and the result or
//! error of that integration counts; so is a member that turns out to be stiff under
//! [`Method::Auto`](crate::Method::Auto).
//!
//! `plan` holds what all members share, if lanes can integrate them; `field` evaluates f on a tape;
//! `step`, `start` and `dense` make the tapes of a `problem`, which `kernels` compiles and a
//! `shelf` caches; `stiffness` counts suspect steps. An `octet` steps eight lanes; a `block`
//! alternates between two of them, and fills their lanes with members from `waiting`.

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
mod stiffness;
mod waiting;
