//! A second derivation of the equations of motion of a text model, and its comparison with the first.
//!
//! The first turns the text into expressions of a graph, which is simplified by fingerprints, and these into
//! machine code. The second shares nothing with it but the parsed text. It evaluates the syntax trees over
//! dual numbers, which gives every derivative, sets up Lagrange's equations with multipliers at one state and
//! solves them by dense elimination with pivoting: no graph, no frame with its brackets where the frame
//! determines these, no rewriting. Where the rank of the frame is below the number of quasi-velocities, the
//! equations (9) are taken by their definition, with the brackets given.
//!
//! [`verify`] compares both at random states on the constraints, in each form that the program offers. It compares ẋ,
//! η̇ or ẏ, the multipliers, the energy with its rate, integrals and outputs.
//!
//! ```
//! use pc_model::{Builtin, Model};
//! use pc_verify::{Options, verify};
//!
//! let model = Model::new(Builtin::named("chaplygin-sleigh").unwrap().document()?);
//! let agreement = verify(&model, &Options::default())?;
//! assert_eq!(agreement.states, 100);
//! assert!(agreement.error < 1e-13);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # Around it
//!
//! Below: [`pc_model`], the text and the first derivation. Above: [pc-report](../pc_report/index.html) and
//! [pc-cli](../pc_cli/index.html), which refuses a motion on which the two disagree.

mod agreement;
mod balance;
mod body;
mod brackets;
mod compare;
mod constants;
mod couplings;
mod derivation;
mod equations;
mod error;
mod first;
mod force_function;
mod forces;
mod here;
mod linear;
mod natural;
mod number;
mod outlet;
mod place;
mod point;
mod printed;
mod projected;
mod quantities;
mod quantity;
mod resets;
mod resultant;
mod resultants;
mod rounding;
mod second;
mod sized;
mod slopes;
mod solved;
mod states;
mod structure;
mod summands;
mod term;
#[cfg(test)]
mod tests;
mod text;
mod tolerance;
mod tree;
mod units;
mod unsteady;
mod velocities;

pub use agreement::Agreement;
pub use compare::{Options, verify};
pub use error::{Disagreement, Unable, VerifyError};
pub use outlet::{Outlet, vouch};
pub use resets::Jump;
pub use second::Second;
pub use slopes::Slope;
pub use tolerance::TOLERANCE;
