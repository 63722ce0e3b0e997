//! From expressions to a compiled motion.
//!
//! All equations are one kind of [first-order system](first_order::FirstOrder), ẏ = g(t, y, w) with M w = r. Its mass
//! matrix is eliminated in expressions ([`unrolled`], by [`ldl`]) or in numbers ([`staged`], by [`dense_ldl`]), as
//! [`elimination`] finds cheaper. Where the equations of w are not linear, they are solved in numbers by Newton's
//! method ([`implicit`]). Under constraints w has multipliers, the matrix is [`saddle`]-shaped, and the states lie on a
//! [`surface`]; first integrals may be [`kept`]. Momenta of such states are [changed](in_momenta) into their
//! quasi-velocities and back.

pub(crate) mod columns;
pub(crate) mod dense_ldl;
pub(crate) mod elimination;
pub(crate) mod fault;
pub(crate) mod first_order;
pub(crate) mod implicit;
pub(crate) mod in_momenta;
pub(crate) mod kept;
pub(crate) mod ldl;
pub(crate) mod machine_code;
pub(crate) mod motion;
pub(crate) mod options;
pub(crate) mod pivots;
pub(crate) mod rounding;
pub(crate) mod saddle;
pub(crate) mod solver;
pub(crate) mod staged;
pub(crate) mod surface;
pub(crate) mod unrolled;
