//! Uneven ground under contacts, as definitions.
//!
//! A ground has six: its height f at the point of contact, f_x and f_y, and the unit normal (−f_x, −f_y, 1)/|…|.

use pc_model::document::{Contact, Document};

use crate::error::Unable;
use crate::text::arithmetic::{dot, negative, quotient, root};
use crate::text::names::Names;
use crate::text::slope::slope;
use crate::text::term::Term;

/// The number of definitions of a ground.
const OF_GROUND: usize = 6;

/// The uneven grounds of a document.
fn grounds(document: &Document) -> impl Iterator<Item = &Contact> {
    document.contacts.iter().filter(|contact| contact.height.is_some())
}

fn label(contact: &Contact) -> String {
    format!("the ground of {}", contact.name.text)
}

/// The names of the definitions, which serve only for error messages and to find them.
pub(crate) fn names(document: &Document) -> Vec<String> {
    grounds(document).flat_map(|contact| std::iter::repeat_n(label(contact), OF_GROUND)).collect()
}

/// The definitions, in the order of their names.
pub(crate) fn definitions(document: &Document, names: &Names) -> Result<Vec<Term>, Unable> {
    let mut all = Vec::new();
    for contact in grounds(document) {
        let Some(height) = &contact.height else { continue };
        let height = names.resolve(&height.ast)?;
        let mut slopes = [Term::Number(0.0), Term::Number(0.0)];
        for (&axis, name) in contact.along.iter().zip(contact.coordinates()) {
            let x = names.coordinates.iter().position(|known| *known == name.text);
            let x = x.ok_or_else(|| Unable::UnknownName { name: name.text.clone() })?;
            slopes[axis] = slope(&height, x, &names.functions);
        }
        let ground = Ground::of(contact, names)?;
        let defined = [1, 2].map(|i| match &slopes[i - 1] {
            Term::Number(value) => Term::Number(*value),
            _ => Term::Definition(ground.first + i),
        });
        let upwards = [negative(defined[0].clone()), negative(defined[1].clone()), Term::Number(1.0)];
        let length = root(dot(&upwards, &upwards));
        all.push(height);
        all.extend(slopes);
        all.extend(upwards.into_iter().map(|part| quotient(part, &length)));
    }
    Ok(all)
}

/// The ground under a contact.
#[derive(Clone, Copy)]
pub(crate) struct Ground {
    /// The place of its first definition.
    first: usize,
}

impl Ground {
    /// The ground of a contact that has one.
    pub(crate) fn of(contact: &Contact, names: &Names) -> Result<Ground, Unable> {
        let label = label(contact);
        let first = names.definitions.iter().position(|name| *name == label);
        Ok(Ground { first: first.ok_or(Unable::UnknownName { name: label })? })
    }

    /// The height at the point of contact.
    pub(crate) fn height(self) -> Term {
        Term::Definition(self.first)
    }

    /// The derivative of the height along an axis.
    pub(crate) fn slope(self, axis: usize) -> Term {
        Term::Definition(self.first + 1 + axis)
    }

    /// The unit normal.
    pub(crate) fn normal(self) -> Vec<Term> {
        (self.first + 3..self.first + OF_GROUND).map(Term::Definition).collect()
    }
}
