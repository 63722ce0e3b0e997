//! End-to-end tests and reference data of the workspace.
//!
//! The data stand on their own feet: nothing here uses the library that it judges. There are end states known to
//! sixteen digits ([`mod@reference`]), the equations of motion as the textbooks print them ([`classical`]), motions
//! in closed form ([`closed_form`]) and model files that must be refused ([`malformed`]). The unit tests hold the
//! first three against each other, so that a disagreement with the library is a fault of the library.

pub mod classical;
pub mod closed_form;
pub mod malformed;
pub mod reference;

/// The programs of the README, compiled and run.
#[cfg(doctest)]
#[doc = include_str!("../../README.md")]
pub struct Readme;
