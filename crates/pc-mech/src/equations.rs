//! Equations of motion in expressions: Poincaré's (9) and Chetaev's (10), (11).
//!
//! In goes a [`System`](crate::System), out come [`Equations`](poincare::Equations) M η̇ = r, or, by the `legendre`
//! transformation, the [`Canonical`](canonical::Canonical) ones; `momenta` puts functions of velocities in their terms, `book` sets
//! them as sums of products.

pub(crate) mod book;
pub(crate) mod canonical;
pub(crate) mod legendre;
pub(crate) mod momenta;
pub(crate) mod poincare;
