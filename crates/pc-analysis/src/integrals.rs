//! Integrals of a motion: rates along it, momenta of cyclic displacements, integrals from an ansatz.
//!
//! The equations yield the rates of functions, with verdicts, and integrals that are proved. `rates`
//! differentiates along the motion, for all values of the parameters or for their `present_values`, and with symbols for `long_constants`, `cyclic_displacements` finds integrals that are momenta, and `ansatz`
//! finds those of a given form, composed of the products in `polynomials`; `integral` is a function with its
//! verdict, `search` combines all of these with Casimirs, and `polynomial_search` adds integrals of a given
//! ansatz. `level` judges functions on levels of known integrals, where `vanishing` proves rates to be zero.
//! `noether` finds the field to which an integral linear in η belongs.

pub(crate) mod ansatz;
pub(crate) mod cyclic_displacements;
pub(crate) mod integral;
pub(crate) mod level;
pub(crate) mod long_constants;
pub(crate) mod noether;
pub(crate) mod polynomial_search;
pub(crate) mod polynomials;
pub(crate) mod present_values;
pub(crate) mod rates;
pub(crate) mod search;
pub(crate) mod vanishing;
