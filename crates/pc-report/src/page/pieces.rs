//! The pieces of a page, for a page that is put together elsewhere and changes while it is read.
//!
//! Its style is [`style`]; its scripts are [`VIEWER`], which plays the data of a [`Scene`](crate::Scene::data), and
//! [`PLOTS`], which draws those of [`plots`]. Formulas and verdicts are [markup](equations()) without scripts.

use pc_model::{Assembly, Model, ModelError};
use pc_print::{Form, Layout, displayed_equations};
use serde_json::Value;

use crate::check::check::Check;
use crate::page::html::{described, paragraph};
use crate::page::pairs::pairs;
use crate::page::plots::Plots;
use crate::page::report::WIDTH;
use crate::page::{equations, motion};
use crate::recording::Recording;

pub use crate::page::html::{data, style, text};
pub use crate::page::player::VIEWER;
pub use crate::page::plots::SCRIPT as PLOTS;

/// The equations of an assembled model in one form, under a heading; a sentence where they are too long for a page.
///
/// # Errors
/// [`ModelError`] for a form that the model does not have.
pub fn equations(model: &Model, assembly: &Assembly<'_>, form: Form) -> Result<String, ModelError> {
    let layout = Layout { width: WIDTH, ..Layout::default() };
    let displayed = displayed_equations(form, &layout, model.title(), assembly)?;
    let (name, option) = (&displayed.name, form.name());
    let long = || {
        paragraph(&format!("{name}: too long to be shown here, but pc derive --form {option} prints them."))
    };
    Ok(equations::form(&displayed).unwrap_or_else(long))
}

/// The properties of a model as a table.
pub fn verdicts(check: &Check<'_>) -> String {
    described(&check.entries())
}

/// The data of the plots of a motion: times, charts and portraits.
pub fn plots(assembly: &Assembly<'_>, record: &Recording) -> Value {
    let groups = motion::groups(record, &pairs(assembly, record));
    Plots::of(groups.into_iter().flat_map(|group| group.panels)).data()
}
