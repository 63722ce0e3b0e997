//! The equations of a model on a page.

use pc_expr::Folding;
use pc_mech::{Graph, MechError};
use pc_model::{Assembly, ModelError};

use crate::equations::derived::Derived;
use crate::equations::form::Form;
use crate::equations::operations::Operations;
use crate::equations::sheet::Sheet;
use crate::language::bodies;
use crate::language::json;
use crate::language::latex;
use crate::language::text;
use crate::layout::format::Page;
use crate::layout::layout::Layout;
use crate::words::visible::{one_line, visible, visible_json};

/// The equations of an assembled model, called `title`, in one of their forms.
///
/// # Errors
/// [`ModelError`] if they cannot be derived.
pub fn page(
    form: Form,
    page: Page,
    layout: &Layout,
    title: &str,
    assembly: &Assembly<'_>,
) -> Result<String, ModelError> {
    let (name, derived) = Derived::new(form, assembly)?;
    let derived = if layout.reactions { derived.with_reactions(form, assembly)? } else { derived };
    let paper = assembly.system.graph().page(Folding::Structural);
    let system = derived.equations.system();
    if let (Form::Poincare, Some(tree)) = (form, system.large_tree()) {
        let operations = assembly.placed(Operations::of(&derived.equations).map_err(MechError::from))?;
        let heading = format!("{}: {name}", one_line(title));
        let tree = bodies::tree_on_page(system, tree, &paper);
        return Ok(match page {
            Page::Text => on_terminal(bodies::text(&heading, &tree, &operations, layout)),
            Page::Latex => bodies::latex(&heading, &tree),
            Page::Json => visible_json(&bodies::programs(title, system, &tree, &operations)) + "\n",
        });
    }
    let (name, sheet, operations) = sheet_of(form, name, &derived, assembly, &paper)?;
    let heading = format!("{}: {name}", one_line(title));
    Ok(match page {
        Page::Text => {
            on_terminal(text::underlined(&heading) + &text::page(&sheet, &operations, layout, &paper))
        }
        Page::Latex => latex::page(&heading, &sheet, layout, &paper),
        Page::Json => visible_json(&json::page(title, &sheet, &operations, layout, &paper)) + "\n",
    })
}

/// The sheet of equations in a given form, with the name of the form and the cost of a right-hand side.
pub(crate) fn sheet_of<'g, 'p>(
    form: Form,
    name: &'static str,
    derived: &Derived<'g>,
    assembly: &Assembly<'g>,
    paper: &'p Graph,
) -> Result<(&'static str, Sheet<'p>, Operations), ModelError> {
    let (name, sheet, operations) = match form.variables().filter(|variables| variables.has_momenta()) {
        Some(variables) => {
            let equations = assembly.placed(assembly.free_form(variables)?.system.canonical())?;
            let sheet = Sheet::of_momenta(assembly, derived, &equations, paper);
            let name = if form == Form::Canonical { "canonical equations" } else { name };
            (name, sheet, Operations::of_canonical(&equations))
        }
        None => {
            let sheet = Sheet::of_velocities(assembly, derived, paper);
            (name, sheet, Operations::of(&derived.equations))
        }
    };
    let operations = assembly.placed(operations.map_err(MechError::from))?;
    Ok((name, sheet, operations))
}

/// The text made safe for a terminal: a program may have given constraints arbitrary names.
fn on_terminal(text: String) -> String {
    match visible(&text) {
        std::borrow::Cow::Borrowed(_) => text,
        std::borrow::Cow::Owned(shown) => shown,
    }
}
