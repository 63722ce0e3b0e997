//! Identities, decided by values in prime fields (Schwartz, Zippel).
//!
//! This module decides whether nodes are zero, equal, or linearly dependent, with an error probability below
//! 2⁻¹⁰⁰. Read `prime_field` (arithmetic in GF(2⁶¹−c)), `fingerprint` (values in two such fields), `roots`
//! (values that contain roots), `circle_point` (sines and cosines); the graph gives each node such a value.
//! Then come questions about several nodes at once: `rank`, by independent `blocks`, and `linear_relations`,
//! by elimination in `echelon` of the values of a `sampler`; `relations_over` has functions of symbols as coefficients, read
//! back as a `rational_function` each, and `degree` is that of a polynomial. If constants are rounded, numerical values decide, weighed by their
//! `running_error`.

pub(crate) mod blocks;
pub(crate) mod circle_point;
pub(crate) mod degree;
pub(crate) mod echelon;
pub(crate) mod fingerprint;
pub(crate) mod linear_relations;
pub(crate) mod prime_field;
pub(crate) mod rank;
pub(crate) mod rational_function;
pub(crate) mod relations_over;
pub(crate) mod roots;
pub(crate) mod running_error;
pub(crate) mod sampler;
