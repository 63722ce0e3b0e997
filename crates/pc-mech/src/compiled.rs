//! From expressions to a compiled motion.
//!
//! All equations are one kind of [first-order system](first_order::FirstOrder), ẏ = g(t, y, w) with M w = r. Read that
//! first, then `elimination`, how w is found, `implicit` for equations that are not linear in w, and `motion`, the vector
//! field that results, with `options` and `machine_code`. Under constraints states lie on a manifold and integrals may be
//! kept: `projection`. `in_momenta` changes momenta of such states into quasi-velocities and back, `running_error` bounds
//! rounding, and `failure` says why there are no rates.

pub(crate) mod elimination;
pub(crate) mod failure;
pub(crate) mod projection;
pub(crate) mod running_error;

pub(crate) mod first_order;
pub(crate) mod implicit;
pub(crate) mod in_momenta;
pub(crate) mod machine_code;
pub(crate) mod motion;
pub(crate) mod options;
