//! End-to-end tests and reference data of the workspace.
//!
//! The data stand on their own feet: they use nothing of the library that they judge. There are end states
//! known to sixteen digits ([`mod@reference`]), the equations of motion as the textbooks print them
//! ([`classical`]), motions in closed form ([`closed_form`]) and model files that must be refused
//! ([`malformed`]). The unit tests hold the first three against each other, so that a disagreement with the
//! library is a fault of the library.
//!
//! The rest serves several tests: nonholonomic systems described by closures ([`nonholonomic`]), the definition
//! of the equations in numbers, which has the library evaluate expressions and nothing else ([`definition`],
//! over the numbers of [`dual`]), a measure for what rounding may do to a program ([`magnitude`]) and a
//! workbench for emitted source ([`emitted`]), systems behind the C interface ([`through_c`]). Models of tests are derived twice ([`verified`]). Random models have a room of their own
//! ([`fuzz`]), and so have attacks on the program from outside ([`attack`]).

pub mod attack;
pub mod classical;
pub mod closed_form;
pub mod definition;
pub mod dual;
pub mod emitted;
pub mod fuzz;
pub mod magnitude;
pub mod malformed;
pub mod nonholonomic;
pub mod reference;
pub mod through_c;
pub mod verified;

/// The programs of the README, compiled and run.
#[cfg(doctest)]
#[doc = include_str!("../../README.md")]
pub struct Readme;

/// The programs of the page on the layers.
#[cfg(doctest)]
#[doc = include_str!("../../docs/layers.md")]
pub struct Layers;
