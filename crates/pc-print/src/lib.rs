//! The equations of a model in print: as a book has them, in LaTeX for a paper, as JSON for programs.
//!
//! A [`page`] is what `pc derive` and `pc_system_print` of the C interface show. Its parts are there too: what is
//! [derived](Derived) in each [`Form`], the [cost](Operations) of a right-hand side, and the lines of
//! [kinematics](kinematics()), [brackets](brackets()) and [equations](balance()). The [`theory`](theory()) is what `pc theory` and
//! `pc_system_theory` show.
//!
//! In goes an [`Assembly`](pc_model::Assembly), out comes text. Read `form` and `derived` first, the equations with what belongs
//! to them; then `operations`, what they cost, and `constraints`, `lines` and `sides`, which every page is made of, and
//! `visible`, by which text of others is no more than text; then `text`, `latex` and `json`, the three ways to print, and `page`, which chooses. `theory` has what can be said of motions, `words` numbers and lists for it.
//!
//! ```
//! use pc_mech::Graph;
//! use pc_model::Builtin;
//! use pc_print::{Form, Page, page};
//!
//! let model = pc_model::Model::new(Builtin::named("chaplygin-sleigh").unwrap().document()?);
//! let graph = Graph::new();
//! let assembly = model.assemble(&graph)?;
//! let printed = page(Form::Poincare, Page::Text, model.title(), &assembly)?;
//! assert!(printed.contains("Reactions\n  λ_"));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod constraints;
mod derived;
mod form;
mod json;
mod latex;
mod lines;
mod operations;
mod page;
mod sides;
mod text;
mod theory;
mod visible;
mod words;

pub use constraints::kind_in_words;
pub use derived::{Derived, energy_remark};
pub use form::Form;
pub use lines::{columns, combination};
pub use operations::{Operations, counted};
pub use page::{Page, page};
pub use text::{balance, brackets, kinematics, recognised};
pub use theory::integrals::integrals_of;
pub use theory::measure::reducing_multiplier;
pub use theory::options::TheoryOptions;
pub use theory::page::theory;
pub use theory::steady::{eigenvalues_in_words, stability_in_words};
pub use visible::{one_line, visible, visible_json};
pub use words::{short, small, wrapped};
