//! Equations of motion as expressions: Poincaré's (9) and Chetaev's (10), (11).
//!
//! A [`System`](crate::System) has the [`Equations`](poincare::Equations) M η̇ = r, or, after the `legendre`
//! transformation, [`Canonical`](canonical::Canonical) equations; `momenta` expresses functions of velocities in
//! momenta, `book` writes the equations as sums of products, and `functions` compiles expressions of their state.
//! `force_balance` gives the same equations by Kane and by Gibbs and Appell, and `maggi` by Maggi, without brackets. `coriolis` has the terms that are quadratic in the quasi-velocities, as a
//! matrix.

pub(crate) mod book;
pub(crate) mod canonical;
pub(crate) mod coriolis;
pub(crate) mod force_balance;
pub(crate) mod functions;
pub(crate) mod legendre;
pub(crate) mod maggi;
pub(crate) mod momenta;
pub(crate) mod poincare;
