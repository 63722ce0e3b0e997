//! A second derivation of the equations of motion of a text model, and its comparison with the first.
//!
//! The first derivation turns the text into expressions of a graph, which is simplified using fingerprints,
//! and compiles these to machine code. The second derivation shares only the parsed text with the first. It
//! evaluates the syntax trees over dual numbers, which gives every derivative, sets up Lagrange's equations
//! with multipliers at one state and solves them by dense elimination with pivoting. The second derivation
//! uses no graph, no rewriting, and no brackets as long as the frame determines them. If the rank of the
//! frame is below the number of quasi-velocities, equations (9) are used in their original form, with the
//! given brackets.
//!
//! [`verify`] compares the two derivations at random states that satisfy the constraints, in each form that the
//! program offers. It compares ẋ, η̇ or ẏ, the multipliers, the energy with its rate, integrals and outputs.
//!
//! ```
//! use pc_model::{Builtin, Model};
//! use pc_verify::{Options, verify};
//!
//! let model = Model::new(Builtin::named("chaplygin-sleigh").unwrap().document()?);
//! let agreement = model.derived(|assembly| verify(&model, assembly, &Options::default()))?;
//! assert_eq!(agreement.states, 100);
//! assert!(agreement.error < 1e-13);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # Around it
//!
//! Lower layers: [`pc_model`], the text and the first derivation. Upper layers:
//! [pc-report](../pc_report/index.html) and [pc-cli](../pc_cli/index.html), which refuses a motion on which
//! the two derivations disagree.

mod comparison;
mod derivation;
mod error;
mod numbers;
#[cfg(test)]
mod tests;
mod text;

pub use comparison::agreement::Agreement;
pub use comparison::compare::{LONG_EQUATIONS, Options, verify};
pub use comparison::outlet::{Outlet, vouch};
pub use comparison::resets::Jump;
pub use comparison::second::Second;
pub use comparison::slopes::Slope;
pub use comparison::tolerance::TOLERANCE;
pub use error::{Disagreement, Unable, VerifyError};
