//! From expressions to a compiled motion.
//!
//! All equations are brought into the form of one kind of [first-order system](first_order::FirstOrder), ẏ = g(t, y, w) with
//! M w = r. Read that first, then `elimination` (how w is found), `implicit` (equations that are not linear in w), `compile`,
//! and `motion`, the resulting `vector_field`, with `options` and `machine_code`. Under constraints states lie on a manifold,
//! to which `projection` and `on_constraints` return them; a projection can also keep integrals constant.
//! `legendre_transform` converts momenta into quasi-velocities and back; `in_momenta` is the motion in momenta under
//! constraints, `forced_motion` the motion under forces that the caller computes. `running_error` bounds rounding
//! errors, `point` holds the arguments at which functions are evaluated, `chart` detects where quasi-velocities and
//! velocities no longer determine each other, `change_point` detects where constraints lose rank; `mass_factors` solves
//! equations with the matrix M alone, `inverse_dynamics` has the forces that accelerations require, `coriolis_matrix` the part of them
//! that is quadratic in the velocities, `velocity_map` the Jacobians of points and of the momentum, `impulse` the jump
//! of velocities by an impulse; `jumps` finds where rates jump, `switches` keeps piecewise rates on one side of these jumps,
//! with the `surface_slopes` between them and what `holds` the motion on them, and `failure` says why rates are undefined.

pub(crate) mod change_point;
pub(crate) mod chart;
pub(crate) mod compile;
pub(crate) mod elimination;
pub(crate) mod failure;
pub(crate) mod point;
pub(crate) mod projection;
pub(crate) mod running_error;

pub(crate) mod coriolis_matrix;
pub(crate) mod first_order;
pub(crate) mod forced_motion;
pub(crate) mod holds;
pub(crate) mod implicit;
pub(crate) mod impulse;
pub(crate) mod in_momenta;
pub(crate) mod inverse_dynamics;
pub(crate) mod jumps;
pub(crate) mod legendre_transform;
pub(crate) mod machine_code;
pub(crate) mod mass_factors;
pub(crate) mod motion;
pub(crate) mod on_constraints;
pub(crate) mod options;
pub(crate) mod surface_slopes;
pub(crate) mod switches;
pub(crate) mod vector_field;
pub(crate) mod velocity_map;
