//! The consistency and the properties of a model.
//!
//! The properties of a model are collected in a [`Check`](check::Check). `frame` describes its frame,
//! `combinations` its constraints, `integrals` the conserved quantities, `measure` the invariant measure, `steady`
//! the nearest steady motion, `agreement` the second derivation; `check` combines these as text or as JSON,
//! `findings` as one row of a table.

pub(crate) mod agreement;
pub(crate) mod check;
mod combinations;
pub(crate) mod findings;
mod frame;
mod integrals;
mod measure;
mod steady;
