//! The equations of a model in print: as text set as in a book, as LaTeX for a paper, as JSON for programs.
//!
//! A [`page`](page()) is the output of `pc derive` and of `pc_system_print` of the C interface. Its parts are also
//! public: the [`Derived`] equations in each [`Form`], the [`Sheet`] of their printed expressions, and the
//! [cost](Operations) of a right-hand side. The [`Theory`] is the output of `pc theory` and `pc_system_theory`.
//!
//! This crate turns an [`Assembly`](pc_model::Assembly) into text. Read `form` and `derived` first (the
//! equations with their constraints and reactions); then `sheet`, the expressions to print, and `operations`,
//! their cost; `part` and `layout`, headings and lines, with `lines` and `constraints`, words and columns,
//! and `visible`, which makes foreign text harmless; then `text`, `latex` and `json`, the three ways to
//! print, `mathml` with `displayed`, formulas for a browser, `bodies`, the page of a large tree of bodies,
//! and `page`, which chooses. `theory` prints the analysis of motions, with `words` for numbers and lists.
//!
//! ```
//! use pc_mech::Graph;
//! use pc_model::Builtin;
//! use pc_print::{Form, Layout, Page, page};
//!
//! let model = pc_model::Model::new(Builtin::named("chaplygin-sleigh").unwrap().document()?);
//! let graph = Graph::new();
//! let assembly = model.assemble(&graph)?;
//! let printed = page(Form::Poincare, Page::Text, &Layout::default(), model.title(), &assembly)?;
//! assert!(printed.contains("Reactions\n  λ_"));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # Around it
//!
//! Lower layers: [`pc_model`], whose equations it prints, and [`pc_analysis`], the analysis of motions.
//! Upper layers: [pc-report](../pc_report/index.html), which puts all of this on one page, and
//! [pc-cli](../pc_cli/index.html).

mod equations;
mod language;
mod layout;
mod page;
mod theory;
mod words;

pub use equations::constraints::kind_in_words;
pub use equations::derived::{Derived, SolvedBracket, energy_remark};
pub use equations::form::Form;
pub use equations::operations::{Operations, counted};
pub use equations::principle::{ForceSheet, InertiaSheet, MaggiSheet, Principle};
pub use equations::sheet::{Balance, Bracket, Brackets, Sheet, recognised};
pub use language::mathml::DisplayedEquation;
pub use layout::format::Page;
pub use layout::layout::Layout;
pub use page::displayed::{
    Display, DisplayedEntry, DisplayedEquations, DisplayedPart, DisplayedTheory, displayed_equations,
    displayed_system, displayed_theory,
};
pub use page::page::page;
pub use theory::bracket_of::bracket_of;
pub use theory::description::Theory;
pub use theory::extent::Extent;
pub use theory::integrals::{integrals_of, level_in_words};
pub use theory::linear_model::LinearModel;
pub use theory::measure::reducing_multiplier;
pub use theory::options::TheoryOptions;
pub use theory::steady::{eigenvalues_in_words, stability_in_words};
pub use words::lines::{columns, combination};
pub use words::visible::{one_line, visible, visible_json};
pub use words::words::{assignments, labelled, short, small, wrapped};
