//! Runs of models: the options become a plan, the plan a motion, and the motion a table.
//!
//! ```text
//! Wishes ─ Model ─► Plan ─► Run ─► table, summary, record
//! Variation ─► Design ─► Sweep ─► Journal ─► table, picture
//! StateChoice ─► Linearized, Locus, Found     two Runs ─► Compared
//! ```
//! The program `pc` and the Python package are front ends of this crate: they supply the options, watch as an
//! [`Observer`](observer::Observer), and show the results. Whatever the front end, the same options give the same numbers,
//! and these are compared with the same second derivation.
//!
//! ```
//! use pc_model::{Builtin, Model};
//! use pc_run::Wishes;
//! use pc_run::motion::integrate::Besides;
//! use pc_run::motion::run::{Ending, Run};
//! use pc_run::observer::Nobody;
//!
//! let model = Model::new(Builtin::named("heavy-top-lagrange").expect("built in").document()?);
//! let wishes = Wishes { t_end: Some(2.0), samples: Some(5), ..Wishes::default() };
//! let besides = Besides { verify: true, ..Besides::default() };
//! let run = Run::of(&model, &wishes, &besides, None, &Nobody)?;
//! assert!(matches!(run.ending, Ending::Completed));
//! assert_eq!(run.table.len(), 5);
//! let energy = run.table.conserved().last().expect("a column");
//! assert!(run.table.drift(energy).absolute < 1e-7);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # Around it
//!
//! Below: [`pc_model`] for the models, [`pc_verify`] for the second derivation, [`pc_solve`] for the motions, [`pc_analysis`]
//! for linearizations and equilibria, and [`pc_report`] for pictures and pages. Above: [pc-cli](../pc_cli/index.html), the
//! program `pc`.

mod category;
mod chain;
pub mod compare;
mod error;
pub mod files;
pub mod linear;
pub mod motion;
pub mod observer;
mod plan;
pub mod sweep;
pub mod table;

pub use category::Category;
pub use chain::chain;
pub use error::RunError;
pub use plan::{Plan, Tolerances, Wishes};
