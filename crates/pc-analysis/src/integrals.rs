//! Integrals of a motion: rates along it, momenta of cyclic displacements, integrals from an ansatz.
//!
//! The equations yield the rates of functions, with verdicts, and integrals that are proved. `rates`
//! differentiates along the motion, `cyclic_displacements` finds integrals that are momenta, and `ansatz`
//! finds those of a given form, composed of the products in `polynomials`; `integral` is a function with its
//! verdict, `search` combines all of these with Casimirs, and `polynomial_search` adds integrals of a given
//! ansatz. `noether` finds the field to which an integral linear in η belongs.

pub(crate) mod ansatz;
pub(crate) mod cyclic_displacements;
pub(crate) mod integral;
pub(crate) mod noether;
pub(crate) mod polynomial_search;
pub(crate) mod polynomials;
pub(crate) mod rates;
pub(crate) mod search;
