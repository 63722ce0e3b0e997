//! Pieces of text that know how tightly they bind.

use crate::graph::number::Number;

/// How tightly a piece of text binds.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Binding {
    Sum,
    Product,
    Power,
    Atom,
}

pub(crate) struct Piece {
    pub(crate) text: String,
    pub(crate) binding: Binding,
}

impl Piece {
    pub(crate) fn atom(text: impl Into<String>) -> Piece {
        Piece { text: text.into(), binding: Binding::Atom }
    }

    pub(crate) fn at_least(self, binding: Binding) -> String {
        if self.binding >= binding { self.text } else { format!("({})", self.text) }
    }
}

pub(crate) fn number(c: Number) -> Piece {
    let text = if c == Number::UNDEFINED { "undefined".to_owned() } else { c.to_string() };
    let binding = if text.starts_with('-') {
        Binding::Sum
    } else if text.contains('/') {
        Binding::Product
    } else {
        Binding::Atom
    };
    Piece { text, binding }
}
