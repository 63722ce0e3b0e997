//! The styles in which expressions are written.

use crate::graph::function::Function;
use crate::graph::number::Number;
use crate::graph::undetermined::Undetermined;
use crate::print::piece::{Binding, Piece, number};
use crate::print::{book, latex, mathml};

/// The style of the text of an expression.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Style {
    /// The expression language, which the parser reads back.
    Text,
    /// As in a book, in plain characters: `½ m v² cos(θ)`.
    Book,
    /// LaTeX for mathematics mode: Greek letters by name, `x'` as ẋ, digits of names as indices.
    Latex,
    /// MathML for web pages: elements side by side in a row.
    MathMl,
}

impl Style {
    /// A piece, in brackets if it binds less tightly than required.
    pub(super) fn at_least(self, piece: Piece, binding: Binding) -> String {
        match self {
            Style::MathMl if piece.binding < binding => mathml::bracketed(&piece.text),
            _ => piece.at_least(binding),
        }
    }

    /// The sign before a subtracted term.
    pub(super) fn minus(self) -> &'static str {
        if self == Style::MathMl { mathml::MINUS } else { "-" }
    }

    /// The words of a sentence: before the names, between a name and its meaning, and between two such pairs.
    pub(super) fn words(self) -> [&'static str; 3] {
        match self {
            Style::MathMl => mathml::WORDS,
            Style::Text | Style::Book | Style::Latex => [" where ", " = ", ", "],
        }
    }

    /// The sign between two terms.
    pub(super) fn sign(self, negative: bool) -> &'static str {
        match (self, negative) {
            (Style::MathMl, false) => mathml::PLUS,
            (Style::MathMl, true) => mathml::MINUS,
            (_, false) => "+ ",
            (_, true) => "- ",
        }
    }

    pub(super) fn number(self, c: Number) -> Piece {
        match self {
            Style::Text => number(c),
            Style::Book => book::number(c),
            Style::Latex => latex::number(c),
            Style::MathMl => mathml::number(c),
        }
    }

    /// Brackets inside which a line may end.
    pub(super) fn large_brackets(self) -> [&'static str; 2] {
        match self {
            Style::Text | Style::Book => ["(", ")"],
            Style::Latex => ["\\Bigl(", "\\Bigr)"],
            Style::MathMl => mathml::BRACKETS,
        }
    }

    pub(super) fn symbol(self, name: &str) -> Piece {
        Piece::atom(match self {
            Style::Text | Style::Book => name.to_owned(),
            Style::Latex => latex::symbol(name),
            Style::MathMl => mathml::symbol(name),
        })
    }

    pub(super) fn call(self, function: Function, args: Vec<Piece>) -> Piece {
        match self {
            Style::Text | Style::Book => {
                let args: Vec<String> = args.into_iter().map(|arg| arg.text).collect();
                Piece::atom(format!("{}({})", function.name(), args.join(", ")))
            }
            Style::Latex => latex::call(function, args),
            Style::MathMl => mathml::call(function, args),
        }
    }

    /// An undetermined function, or one of its derivatives, at its arguments.
    pub(super) fn applied(self, function: Undetermined, name: &str, args: Vec<Piece>) -> Piece {
        let args: Vec<String> = args.into_iter().map(|arg| arg.text).collect();
        Piece::atom(match self {
            Style::Text | Style::Book => format!("{}({})", function.text(name, &args), args.join(", ")),
            Style::Latex => latex::applied(function, name, &args),
            Style::MathMl => mathml::applied(function, name, &args),
        })
    }

    pub(super) fn power(self, base: Piece, exponent: Piece) -> Piece {
        let text = match self {
            Style::Text => format!("{}^{}", base.at_least(Binding::Atom), exponent.at_least(Binding::Atom)),
            Style::Book => book::power(base, exponent),
            Style::Latex => latex::power(&base, &exponent.text),
            Style::MathMl => mathml::power(&base, &exponent.text),
        };
        Piece { text, binding: Binding::Power }
    }

    pub(super) fn product(self, factors: Vec<Piece>) -> String {
        let factors: Vec<String> = factors.into_iter().map(|p| self.at_least(p, Binding::Product)).collect();
        match self {
            Style::Text => factors.join("*"),
            Style::Book => factors.join(" "),
            Style::Latex => latex::juxtaposed(&factors),
            Style::MathMl => mathml::juxtaposed(&factors),
        }
    }

    pub(super) fn quotient(self, above: Vec<Piece>, mut below: Vec<Piece>) -> String {
        match self {
            Style::Latex => format!("\\frac{{{}}}{{{}}}", latex::alone(above), latex::alone(below)),
            Style::MathMl => mathml::fraction(above, below),
            _ if below.len() == 1 => {
                format!("{}/{}", self.product(above), below.remove(0).at_least(Binding::Power))
            }
            _ => format!("{}/({})", self.product(above), self.product(below)),
        }
    }
}
