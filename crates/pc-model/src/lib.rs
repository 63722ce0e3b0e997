//! The text model: TOML to a mechanical system, with spans in every error.
//!
//! A [`Document`] is what stands in the text, section by section. A [`Model`] is one with the values of its parameters;
//! [assembled](Model::assemble) in a graph, it is an [`Assembly`]: a [`System`](pc_mech::System) in quasi-velocities with
//! its start, the constraints, and in which way they [bind](Bound) it. Any consistent units will do.
//!
//! ```
//! use pc_mech::Graph;
//! use pc_model::{Document, Model, Source};
//!
//! let text = r#"
//! [coordinates]
//! x = 1.0
//! [lagrangian]
//! kinetic = "x'^2/2"
//! potential = "2*x^2"
//! "#;
//! let model = Model::new(Document::parse(Source::new("oscillator.toml", text))?);
//! let graph = Graph::new();
//! let assembly = model.assemble(&graph)?;
//! let equations = assembly.system.poincare().map_err(|error| model.derivation_error(error))?;
//! assert_eq!(equations.right_hand_side()[0].to_string(), "-4*x");
//! # Ok::<(), pc_model::ModelError>(())
//! ```

mod assembly;
mod bound;
mod builtin;
mod definite;
pub mod document;
pub mod error;
mod event;
mod external;
mod fault;
mod flow;
mod function;
mod model;
mod parameters;
mod resultant;
mod scope;
pub mod source;
mod start;
mod tables;
mod variables;

pub use bound::{Bound, Form, Held, Verdict};
pub use builtin::{BUILTIN, Builtin};
pub use document::Document;
pub use error::{Category, Diagnostic, ErrorKind, ModelError};
pub use event::Event;
pub use external::NotForced;
pub use fault::Fault;
pub use flow::{Flow, FlowEvents};
pub use model::{Assembly, Model, UnknownIntegral, UnknownParameter};
pub use parameters::Parameters;
pub use source::Source;
pub use start::UnknownStart;
pub use variables::Variables;
