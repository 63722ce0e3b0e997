//! Text models: from TOML to a mechanical system, with the place in the file in every error.
//! `docs/model-format.md` explains the format.
//!
//! A [`Document`] holds the contents of the text, section by section. A [`Model`] is a document with the
//! values of its parameters; [assembled](Model::assemble) in a graph, it is an [`Assembly`]: a
//! [`System`](pc_mech::System) in quasi-velocities with its start, the constraints, and the way in which they
//! [bind](ConstraintTreatment) it. Any consistent units can be used.
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
//! let equations = assembly.equations()?;
//! assert_eq!(equations.right_hand_side()[0].to_string(), "-4*x");
//! # Ok::<(), pc_model::ModelError>(())
//! ```
//!
//! # Around it
//!
//! Below: [`pc_nonholo`] and [`pc_mech`], into whose objects the text of a model is translated. Above:
//! [pc-print](../pc_print/index.html), which prints its equations; [pc-verify](../pc_verify/index.html), which derives them a
//! second time; [pc-fmu](../pc_fmu/index.html), which exports the model to other programs; [pc-cli](../pc_cli/index.html), the
//! program `pc`.

mod assembly;
mod deep;
mod diagnostics;
pub mod document;
#[cfg(feature = "urdf")]
pub mod export;
mod flow;
#[cfg(feature = "urdf")]
pub mod import;
mod model;
mod names;
mod sealed;
mod variables;

pub use assembly::action::Action;
pub use assembly::arrows::{Arrow, Quantity};
pub use assembly::assemble::derivations;
pub use assembly::assembly::Assembly;
pub use assembly::constraint_treatment::{
    ClassifiedConstraint, ConstraintFormulation, ConstraintTreatment, MultiplierFormulation,
};
pub use assembly::event::{Event, Impact};
pub use assembly::external_force::NotForced;
pub use assembly::parameters::Parameters;
pub use assembly::shape::{Shape, Spot};
pub use deep::deep;
pub use diagnostics::category::Category;
pub use diagnostics::error::{Diagnostic, ModelError};
pub use diagnostics::error_kind::ErrorKind;
pub use diagnostics::meaning::MeaningError;
pub use diagnostics::source::{Place, Source};
pub use document::Document;
pub use flow::events::FlowEvents;
pub use flow::flow::Flow;
pub use flow::free_form::FreeForm;
pub use flow::prototype::{MemberValues, Prototype};
pub use flow::tolerances::{ORDINARY_TOLERANCE, absolute_tolerances};
pub use flow::velocity_maps::CentreOfMass;
pub use model::builtin::{BUILTIN, Builtin, CLASSICS, TREES};
pub use model::given::GivenQuasiVelocity;
pub use model::model::{GivenInput, Model, UnknownInput, UnknownIntegral, UnknownParameter};
pub use model::start_values::{UnknownStart, UnknownValue};
pub use model::tags::{TAGS, Tag};
pub use sealed::{SealError, name_of, open, seal};
pub use variables::Variables;
