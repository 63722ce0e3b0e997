//! The equations of a model on a page.

use pc_mech::MechError;
use pc_model::{Assembly, ModelError};

use crate::derived::Derived;
use crate::form::Form;
use crate::operations::Operations;
use crate::visible::{one_line, visible, visible_json};
use crate::{json, latex, text};

/// How equations are printed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Page {
    /// For people.
    Text,
    /// For a paper.
    Latex,
    /// For programs.
    Json,
}

/// The equations of an assembled model, called `title`, in one of their forms.
///
/// # Errors
/// [`ModelError`] if they cannot be derived.
pub fn page(form: Form, page: Page, title: &str, assembly: &Assembly<'_>) -> Result<String, ModelError> {
    let shown = one_line(title);
    if let Some(variables) = form.variables().filter(|variables| variables.has_momenta()) {
        let (name, derived) = Derived::new(form, assembly)?;
        let equations = assembly.placed(assembly.free_form(variables)?.system.canonical())?;
        let operations = assembly.placed(Operations::of_canonical(&equations).map_err(MechError::from))?;
        let name = if form == Form::Canonical { "canonical equations" } else { name };
        let heading = format!("{shown}: {name}");
        return Ok(match page {
            Page::Text => {
                on_terminal(text::underlined(&heading) + &text::canonical(&derived, &equations, &operations))
            }
            Page::Latex => latex::canonical(&heading, &derived, &equations),
            Page::Json => visible_json(&json::canonical(title, &derived, &equations, &operations)) + "\n",
        });
    }
    let (name, derived) = Derived::new(form, assembly)?;
    let heading = format!("{shown}: {name}");
    let operations = assembly.placed(Operations::of(&derived.equations).map_err(MechError::from))?;
    Ok(match page {
        Page::Text => on_terminal(text::underlined(&heading) + &text::poincare(&derived, &operations)),
        Page::Latex => latex::poincare(&heading, &derived),
        Page::Json => visible_json(&json::poincare(title, &derived, &operations)) + "\n",
    })
}

/// Names of constraints may be anything where a program has given them.
fn on_terminal(text: String) -> String {
    match visible(&text) {
        std::borrow::Cow::Borrowed(_) => text,
        std::borrow::Cow::Owned(shown) => shown,
    }
}
