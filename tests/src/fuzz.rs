//! Random models over the whole text format, run through the product and compared with independent computations.
//!
//! ```text
//! seed, number ─ generator ─► Specimen ─ start ─► Start ─ text ─► a model, and its twin in ordinary velocities
//!                                                                    │ execution: every form that the product has
//!                                                                    │ program: commands of `pc` on the same text
//!                             shrink ◄─ Finding ◄─ comparison ◄──────┘
//!                             campaign: many numbers, a report
//! ```
//! A [`Specimen`](specimen::Specimen) is known apart from the product: it has the fields of its frame, what its
//! quasi-velocities are in velocities, and start values that were computed here. Its twin describes the same motion in the
//! coordinates of the chart and their velocities, without frame, quasi-velocities, brackets or carried coordinates, which
//! are `[definitions]` there: Lagrange's equations, so that an error in what the twin has not is seen. A finding is shrunk to a
//! short text that still has it. Bodies on joints have a generator of their own, with bodies that are written out as twins.

pub mod breaks;
pub mod campaign;
pub mod comparison;
mod determined;
mod emission;
pub mod examination;
pub mod execution;
pub mod expression;
pub mod generator;
pub mod program;
pub mod random;
mod regular;
pub mod report;
pub mod shrink;
pub mod specimen;
pub mod start;
pub mod text;
mod trees;
pub mod units;
