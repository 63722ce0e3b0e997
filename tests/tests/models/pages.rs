//! The equations of a model in print.

use pc_print::{Form, Layout, Page, page};

use crate::derived::Derived;

/// The page of a form, if the model has it: of an assembly anew, since what was made in a graph before may be a shorter form of what is
/// made now.
pub(crate) fn printed(derived: &Derived<'_>, form: Form, kind: Page) -> Option<String> {
    derived.anew(|assembly| page(form, kind, &Layout::default(), derived.name, assembly)).ok()
}
