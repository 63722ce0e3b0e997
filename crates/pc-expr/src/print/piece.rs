//! Pieces of text with their binding strength.

use std::f64::consts::PI;

use crate::graph::number::Number;

/// How tightly a piece of text binds.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Binding {
    Sum,
    Product,
    Power,
    Atom,
}

#[derive(Clone)]
pub(crate) struct Piece {
    pub(crate) text: String,
    pub(crate) binding: Binding,
}

impl Piece {
    pub(crate) fn atom(text: impl Into<String>) -> Piece {
        Piece { text: text.into(), binding: Binding::Atom }
    }

    pub(crate) fn product(text: String) -> Piece {
        Piece { text, binding: Binding::Product }
    }

    /// The number of characters.
    pub(crate) fn columns(&self) -> usize {
        self.text.chars().count()
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

/// The numerator and denominator of q if a number is the double nearest to q π, where q > 0 is a simple
/// fraction.
pub(crate) fn multiple_of_pi(c: Number) -> Option<(i32, i32)> {
    let value = match c {
        Number::Scaled { .. } | Number::Real(_) => c.to_f64(),
        // A double nearest to a multiple of π has this many digits.
        Number::Rational { den, .. } if den > 1 << 30 => c.to_f64(),
        Number::Rational { .. } => return None,
    };
    let simple = |den: i32| {
        let num = (value / PI * f64::from(den)).round();
        let next = num * PI / f64::from(den) == value || num / f64::from(den) * PI == value;
        ((1.0..=64.0).contains(&num) && next).then_some((num as i32, den))
    };
    (1..=12).find_map(simple)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn multiples_of_pi_are_known_by_their_digits() {
        let known = |value: f64| multiple_of_pi(Number::from(value));
        assert_eq!(known(2.0 * PI), Some((2, 1)));
        assert_eq!(known(PI / 10.0), Some((1, 10)));
        assert_eq!(known(2.0 * PI / 3.0), Some((2, 3)));
        assert_eq!(known(PI - 1e-12), None);
        assert_eq!(known(-PI), None, "signs are written apart");
        assert_eq!(known(22.0 / 7.0), None);
    }
}
