//! Identities, decided by values in prime fields (Schwartz, Zippel).
//!
//! Decides whether nodes are zero, equal, or linearly dependent, wrong with a probability below 2⁻¹⁰⁰.
//! Read `prime_field` (arithmetic in GF(2⁶¹−c)), `fingerprint` (in two of them at once), `roots` (values that
//! contain roots), `circle_point` (sines and cosines); the graph gives each of its nodes such a value. Then questions
//! about several nodes at once: `rank`, of each of its `blocks`, and, by `echelon`, `linear_relations`.

pub(crate) mod blocks;
pub(crate) mod circle_point;
pub(crate) mod echelon;
pub(crate) mod fingerprint;
pub(crate) mod linear_relations;
pub(crate) mod prime_field;
pub(crate) mod rank;
pub(crate) mod roots;
