//! Everything that is known about a model, on one page.
//!
//! A [`Model`](pc_model::Model) and, if it was integrated, the [`Recording`] of its motion are turned into [one
//! page](report()) for a browser: the text of the model, frame and operators, verdicts, equations in every
//! form that applies, brackets, integrals, steady motions, plots. The page is self-contained and readable
//! without scripts; where scripts run, it plays the motion ([`animation`] is a page with the player alone). A
//! [`Check`] is the output of `pc check`, which is also part of the page.
//!
//! Read `check`, the properties of a model; `record`, the data of a motion, and `scene`, its drawing, with `surfaces`, each a `mesh` of a file; then
//! [`picture`], curves and eigenvalues for the page and for separate files, and `page`, which puts everything
//! under headings. Numbers and formulas come from the lower layers.
//!
//! ```
//! use pc_model::{Builtin, Model};
//!
//! let model = Model::new(Builtin::named("chaplygin-sleigh").unwrap().document()?);
//! let page = model.derived(|assembly| pc_report::report(&model, assembly, None))?;
//! assert!(page.starts_with("<!DOCTYPE html>") && page.contains("<math"));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # Around it
//!
//! Lower layers: [`pc_print`], formulas and words, and [`pc_verify`], the second derivation. Upper layers:
//! [pc-cli](../pc_cli/index.html), where this crate serves `pc report`, `pc animate` and `pc check`.

mod base64;
mod check;
mod error;
#[cfg(feature = "files")]
pub mod files;
mod mesh;
mod page;
pub mod picture;
mod recording;
mod remarks;
mod scene;
mod still;
mod surfaces;

pub use check::check::Check;
pub use check::findings::Finding;
pub use error::ReportError;
pub use mesh::Mesh;
pub use page::pieces;
pub use page::player::animation;
pub use page::report::{Page, report};
pub use recording::{ColumnKind, Columns, Recording, Samples, UnknownColumn};
pub use remarks::{NEGATIVE_ENERGY, changing_masses, dropped};
pub use scene::{Scene, SceneArrow, SceneShape};
