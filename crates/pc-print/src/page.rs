//! The equations of a model on a page.

use pc_mech::MechError;
use pc_model::{Assembly, ModelError};

use crate::derived::Derived;
use crate::form::Form;
use crate::operations::Operations;
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
    if form == Form::Canonical {
        let (_, derived) = Derived::new(form, assembly)?;
        let equations = assembly.placed(assembly.free_system()?.canonical())?;
        let operations = assembly.placed(Operations::of_canonical(&equations).map_err(MechError::from))?;
        let heading = format!("{title}: canonical equations");
        return Ok(match page {
            Page::Text => text::underlined(&heading) + &text::canonical(&derived, &equations, &operations),
            Page::Latex => latex::canonical(&heading, &derived, &equations),
            Page::Json => format!("{:#}\n", json::canonical(title, &derived, &equations, &operations)),
        });
    }
    let (name, derived) = Derived::new(form, assembly)?;
    let heading = format!("{title}: {name}");
    let operations = assembly.placed(Operations::of(&derived.equations).map_err(MechError::from))?;
    Ok(match page {
        Page::Text => text::underlined(&heading) + &text::poincare(&derived, &operations),
        Page::Latex => latex::poincare(&heading, &derived),
        Page::Json => format!("{:#}\n", json::poincare(title, &derived, &operations)),
    })
}
