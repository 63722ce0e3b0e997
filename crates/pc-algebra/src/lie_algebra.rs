//! Lie algebras, given by exact structure constants, and the properties of an algebra as a whole.
//!
//! The c_rs^m are rational numbers, and every property is exact. Read `structure_constants` and `lie_algebra` first;
//! `series` (centre, derived, lower central), `killing`, `rank` and `invariant_forms` return a `subspace`, a number
//! or forms. Algebras come from a `catalogue`, `families`, `matrix_algebra`, or from other algebras by `product` and
//! `representation`; `bianchi` has the named types in three dimensions.

pub(crate) mod bianchi;
pub(crate) mod catalogue;
pub(crate) mod families;
pub(crate) mod invariant_forms;
pub(crate) mod jacobi;
pub(crate) mod killing;
pub(crate) mod lie_algebra;
pub(crate) mod matrix_algebra;
pub(crate) mod product;
pub(crate) mod rank;
pub(crate) mod representation;
pub(crate) mod series;
pub(crate) mod structure_constants;
pub(crate) mod subspace;
