//! The names of components of contacts.

use pc_model::document::Document;

use crate::error::Unable;
use crate::text::contacts::Touching;
use crate::text::names::Names;
use crate::text::term::Term;
use crate::text::tree::Tree;

/// The names of the components of contacts, with their terms.
pub(crate) fn components(
    document: &Document,
    tree: &Tree<'_>,
    names: &Names,
) -> Result<Vec<(String, Term)>, Unable> {
    let mut all = Vec::new();
    for (number, contact) in document.contacts.iter().enumerate() {
        let values = match tree.placed(&contact.body.value) {
            Some(at) => Touching::of(contact, names, at).components(tree.point_of_contact(number), None)?,
            None => {
                let (touching, omega) = Touching::placed(contact, document, names)?;
                touching.components(touching.point()?, omega.as_deref())?
            }
        };
        all.extend(contact.components.iter().map(|name| name.text.clone()).zip(values));
    }
    Ok(all)
}
